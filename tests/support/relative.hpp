#pragma once

// Comparison of numbers that are nearly equal.

#include <cmath>
#include <ostream>

namespace lightswitch::test {

/// `x == relative(value, tolerance)` when x is off by at most that fraction of `value`, however small it is: unlike in
/// doctest, where small means below 1. A `value` of 0 is met by 0 alone, unless `or_absolute` allows an error that does
/// not shrink with it.
class relative {
public:
    constexpr relative(double value, double tolerance)
        : value_(value), allowed_(tolerance * (value < 0 ? -value : value)) {}

    constexpr relative or_absolute(double error) const {
        relative result = *this;
        if (error > allowed_) result.allowed_ = error;
        return result;
    }

    friend bool operator==(double x, const relative& r) { return std::abs(x - r.value_) <= r.allowed_; }
    friend std::ostream& operator<<(std::ostream& out, const relative& r) {
        return out << r.value_ << " +- " << r.allowed_;
    }

private:
    double value_, allowed_;
};

}  // namespace lightswitch::test
