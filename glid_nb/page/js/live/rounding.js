// Bounds on rounding errors in a proof. docs/proof.md ("In the page") derives every constant.

export const UNIT_ROUNDOFF = 1.1102230246251565e-16; // 2^-53

/** A factor larger than the rounding of all sums of positive numbers that make a bound. */
export const UPWARD = 1 + 9.313225746154785e-10; // 1 + 2^-30

/** Within this of half a turn, the angle of an edge may be on the wrong side of the cut. */
export const CUT = 64 * UNIT_ROUNDOFF;

/** How far the end of a panel may lie beside its edge, relative to the largest coordinate. */
export const BESIDE = 64 * UNIT_ROUNDOFF;

/** Largest error of Log(B_{e+1} / B_e), relative to 1 + |Log|. */
const LOGARITHM = 16 * UNIT_ROUNDOFF;

/** Error of a Bernstein coefficient, relative to the largest squares of both interpolants. */
export const BERNSTEIN = 16 * UNIT_ROUNDOFF;

/** Errors of three values enlarge that of their quadratic interpolant by this (Lebesgue). */
const LEBESGUE = 1.25;

/** Is added to all errors, so that nothing is proved of numbers that underflow. */
const UNDERFLOW = 1e-140;

/**
 * A bound on the error of the quadratic interpolant of f_z or conj(f_zbar), without its remainder.
 * @param {number} columns of the basis
 * @param {number} rowNorm the largest norm of the rows at its three nodes
 * @param {number} slopeNorm the norm of the slopes
 * @param {number} slopeSum the sum of the moduli of the slopes along edges
 */
export function slack(columns, rowNorm, slopeNorm, slopeSum) {
  const sums = (3 * columns + 128) * UNIT_ROUNDOFF * rowNorm * slopeNorm;
  const logarithms = (LOGARITHM / Math.PI) * slopeSum;
  return LEBESGUE * UPWARD * (sums + logarithms) + UNDERFLOW;
}
