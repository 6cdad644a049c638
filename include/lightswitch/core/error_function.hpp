#pragma once

// The inverse of the complementary error function, which the standard library lacks.

#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// The x of which `erfc(x)` is `tail`, in (0, 2), to 6 units of roundoff; where x is small, tail - 1 limits it.
///
/// With w = -log(tail (2 - tail)), x / (1 - tail) is a smooth function of w, and of its root where w is large (Giles,
/// "Approximating the erfinv Function", 2012). The polynomials are of least relative error, for w up to 18.8.
inline float inverse_erfc(float tail) {
    const float w = -std::log(tail * (2 - tail));
    if (w < 5) {
        const float t = w - 2.5f;
        const float p =
            0.24664073f +
            t * (-4.1777078e-3f +
                 t * (-1.2537075e-3f +
                      t * (2.1860220e-4f +
                           t * (-4.3967829e-6f + t * (-3.5288609e-6f + t * (3.4372721e-7f + t * 2.8534903e-8f))))));
        return (1 - tail) * (1.5014094f + t * p);
    }
    const float t = std::sqrt(w) - 3;
    const float p =
        1.0016822f + t * (9.4257471e-3f +
                          t * (-7.7192298e-3f +
                               t * (5.8215435e-3f + t * (-3.3870233e-3f + t * (1.1309470e-3f + t * -1.4674967e-4f)))));
    return (1 - tail) * (2.8329774f + t * p);
}

}  // namespace lightswitch
