#pragma once

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch {

/// A value or nothing, for the inner loops: used like `std::optional`, but the value is always there as an object, if
/// an idle one. Compilers keep its members in registers, which they do not with the union inside `std::optional` (GCC
/// 12: a third of the time of path tracing outside of Embree).
template <class T>
class Maybe {
public:
    constexpr Maybe() = default;
    constexpr Maybe(const T& value) : value_(value), has_value_(true) {}

    /// Makes it hold a value, to be filled in through the reference.
    constexpr T& emplace() {
        has_value_ = true;
        return value_;
    }
    constexpr explicit operator bool() const { return has_value_; }
    constexpr bool has_value() const { return has_value_; }
    /// The value; an idle object when there is none.
    constexpr const T& operator*() const { return value_; }
    constexpr T& operator*() { return value_; }
    constexpr const T* operator->() const { return &value_; }
    constexpr T* operator->() { return &value_; }

private:
    T value_{};
    bool has_value_ = false;
};

}  // namespace lightswitch
