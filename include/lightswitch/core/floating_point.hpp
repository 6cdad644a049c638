#pragma once

// Every other header includes this one, by way of others at least: what the library asks of the compiler's arithmetic.
//
// Options that promise the compiler that no number is infinite or NaN let it drop the checks by which the library finds
// those that are, and the infinities that mean "no limit" here. Other options that only let it reorder sums
// (-fassociative-math, -fno-math-errno, -ffp-contract) cost at most equality of bits between machines.

#if (defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)) && \
    !defined(LIGHTSWITCH_ALLOW_FAST_MATH)
#error \
    "lightswitch: compiled with -ffast-math or -ffinite-math-only, checks for infinity and NaN are dropped and \
results are wrong. Leave the option out, add -fno-finite-math-only -fno-fast-math after it, or define \
LIGHTSWITCH_ALLOW_FAST_MATH to do without them."
#endif
