// The logarithm and the angle by which maps are proved.
//
// JavaScript leaves the accuracy of `Math.log`, `Math.atan2`, `Math.hypot` and `**` open, so browsers
// differ. These functions use +, -, *, / and `Math.sqrt` only, which IEEE 754 rounds correctly: every
// browser gives the same bits. docs/proof.md (Lemma 21) says how far they are off.
//
// The algorithms and constants of `log` and `atan` are those of fdlibm:
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunPro, a Sun
// Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software is
// freely granted, provided that this notice is preserved.

const LN2_HIGH = 0.6931471803691238;
const LN2_LOW = 1.9082149292705877e-10;
const TWO_TO_54 = 18014398509481984;
const L1 = 0.6666666666666735;
const L2 = 0.3999999999940942;
const L3 = 0.2857142874366239;
const L4 = 0.22222198432149784;
const L5 = 0.1818357216161805;
const L6 = 0.15313837699209373;
const L7 = 0.14798198605116586;

const A0 = 0.3333333333333293;
const A1 = -0.19999999999876483;
const A2 = 0.14285714272503466;
const A3 = -0.11111110405462356;
const A4 = 0.09090887133436507;
const A5 = -0.0769187620504483;
const A6 = 0.06661073137387531;
const A7 = -0.058335701337905735;
const A8 = 0.049768779946159324;
const A9 = -0.036531572744216916;
const A10 = 0.016285820115365782;

// The arctangents of 1/2, 1, 3/2 and infinity, each as a sum of two numbers.
const ATAN_HIGH = [0.4636476090008061, 0.7853981633974483, 0.982793723247329, 1.5707963267948966];
const ATAN_LOW = [
  2.2698777452961687e-17, 3.061616997868383e-17, 1.3903311031230998e-17, 6.123233995736766e-17,
];
const TINY = 1.862645149230957e-9; // 2^-29
const HUGE = 7.378697629483821e19; // 2^66
const PI_LOW = 1.2246467991473532e-16;

const number = new Float64Array(1);
const words = new Int32Array(number.buffer);
number[0] = 1;
const HIGH = words[1] === 0 ? 0 : 1; // the word that holds sign and exponent

/**
 * The modulus, without protection from overflow.
 * @param {number} x
 * @param {number} y
 */
export function modulus(x, y) {
  return Math.sqrt(x * x + y * y);
}

/**
 * The natural logarithm.
 * @param {number} x
 */
export function log(x) {
  if (!(x > 0) || x === Infinity) {
    return logOfSpecial(x);
  }
  const subnormal = x < 2.2250738585072014e-308;
  number[0] = subnormal ? x * TWO_TO_54 : x;
  const exponent = (words[HIGH] >> 20) - 1023 - (subnormal ? 54 : 0);
  const fraction = words[HIGH] & 0xfffff;
  // x = 2^k (1 + f) with 1 + f between sqrt(1/2) and sqrt(2).
  const carry = (fraction + 0x95f64) & 0x100000;
  words[HIGH] = fraction | (carry ^ 0x3ff00000);
  return logOfParts(exponent + (carry >> 20), number[0] - 1, fraction);
}

/** @param {number} x */
function logOfSpecial(x) {
  if (x === 0) {
    return -Infinity;
  }
  return x === Infinity ? Infinity : NaN;
}

/**
 * log(2^k (1 + f)).
 * @param {number} k
 * @param {number} f
 * @param {number} fraction the upper bits of the argument's fraction
 */
function logOfParts(k, f, fraction) {
  if ((0xfffff & (2 + fraction)) < 3) {
    // |f| < 2^-20
    const r = f * f * (0.5 - 0.3333333333333333 * f);
    return k * LN2_HIGH - (r - k * LN2_LOW - f);
  }
  const s = f / (2 + f);
  const z = s * s;
  const w = z * z;
  const even = w * (L2 + w * (L4 + w * L6));
  const odd = z * (L1 + w * (L3 + w * (L5 + w * L7)));
  const r = odd + even;
  if (((fraction - 0x6147a) | (0x6b851 - fraction)) > 0) {
    const half = 0.5 * f * f;
    return k * LN2_HIGH - (half - (s * (half + r) + k * LN2_LOW) - f);
  }
  return k * LN2_HIGH - (s * (f - r) - k * LN2_LOW - f);
}

/**
 * The angle of the vector (x, y), from -pi to pi; 0 for (0, 0), NaN where a coordinate is not finite.
 * @param {number} y
 * @param {number} x
 */
export function atan2(y, x) {
  if (!Number.isFinite(x) || !Number.isFinite(y)) {
    return NaN;
  }
  const angle = y === 0 ? 0 : atan(Math.abs(y / x));
  if (x >= 0) {
    return y < 0 ? -angle : angle;
  }
  return y < 0 ? angle - PI_LOW - Math.PI : Math.PI - (angle - PI_LOW);
}

/**
 * The arctangent of a number that is not negative, possibly infinite.
 * @param {number} x
 */
function atan(x) {
  if (x < 0.4375) {
    return x < TINY ? x : x - x * atanSeries(x);
  }
  if (x >= HUGE) {
    return ATAN_HIGH[3] + ATAN_LOW[3];
  }
  if (x < 0.6875) {
    return atanFrom(0, (2 * x - 1) / (2 + x));
  }
  if (x < 1.1875) {
    return atanFrom(1, (x - 1) / (x + 1));
  }
  return x < 2.4375 ? atanFrom(2, (x - 1.5) / (1 + 1.5 * x)) : atanFrom(3, -1 / x);
}

/**
 * An arctangent of the table, and that of t beyond it.
 * @param {number} entry
 * @param {number} t
 */
function atanFrom(entry, t) {
  return ATAN_HIGH[entry] - (t * atanSeries(t) - ATAN_LOW[entry] - t);
}

/** 1 - atan(t) / t. @param {number} t */
function atanSeries(t) {
  const z = t * t;
  const w = z * z;
  const odd = z * (A0 + w * (A2 + w * (A4 + w * (A6 + w * (A8 + w * A10)))));
  const even = w * (A1 + w * (A3 + w * (A5 + w * (A7 + w * A9))));
  return odd + even;
}
