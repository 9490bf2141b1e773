// The motions of several shapes as one, with the knots of all.

import { Motion } from "../motion/motion.js";
import { chained } from "./joint_map.js";

/** @import { Reel } from "../live_page/film.js" */

/**
 * @param {Reel[]} reels with the same keyframes
 * @returns {Reel}
 */
export function jointReel(reels) {
  const motions = reels.map(({ times, knots }) => {
    const numbers = chained(knots.map(({ coefficients }) => coefficients));
    return new Motion({ times, repeat: "once" }, numbers);
  });
  const times = [...new Set(reels.flatMap((reel) => reel.times))].sort((a, b) => a - b);
  const knots = times.map((time) => ({
    coefficients: chained(motions.map((motion) => motion.at(time))),
    sigma2: Math.min(
      ...reels.map(({ knots: own }, i) => {
        const { piece } = motions[i].place(time);
        return Math.min(own[piece].sigma2, own[piece + 1].sigma2);
      }),
    ),
  }));
  const [{ keyframes, repeat }] = reels;
  return { times, knots, keyframes, repeat };
}
