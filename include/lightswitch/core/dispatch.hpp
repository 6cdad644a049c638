#pragma once

// Choosing among a fixed list of types by index, without a table of function pointers.

#include <lightswitch/core/floating_point.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace lightswitch {

/// Calls `f(std::integral_constant<std::size_t, index>{})` for the `index` given at run time (below `N`): a chain of
/// comparisons that the compiler can inline into its surroundings; with one alternative no comparison is left.
template <std::size_t N, std::size_t I = 0, class F>
[[gnu::always_inline]] inline decltype(auto) dispatch(std::size_t index, F&& f) {
    static_assert(I < N);
    if constexpr (I + 1 == N) {
        return f(std::integral_constant<std::size_t, I>{});
    } else {
        if (index == I) return f(std::integral_constant<std::size_t, I>{});
        return dispatch<N, I + 1>(index, std::forward<F>(f));
    }
}

/// The position of the first true value, or their number.
template <bool... values>
constexpr std::size_t first_of() {
    std::size_t position = 0;
    static_cast<void>(((values || (++position, false)) || ...));
    return position;
}

/// The position of `T` in `List...`, or the length of the list when it is not there.
template <class T, class... List>
constexpr std::size_t index_of() {
    return first_of<std::is_same_v<T, List>...>();
}

template <class T, class... List>
inline constexpr bool is_one_of = (std::is_same_v<T, List> || ...);

/// Which element of which type: the type in the upper 5 bits, the position among its like below. Made empty.
class TypedIndex {
public:
    static constexpr std::size_t max_position = (1u << 27) - 1;
    static constexpr std::size_t max_kind = 30, kinds = max_kind + 1;

    constexpr TypedIndex() = default;
    /// `kind` at most `max_kind`, `position` at most `max_position`; unchecked.
    constexpr TypedIndex(std::size_t kind, std::size_t position)
        : bits_(static_cast<std::uint32_t>(kind << 27 | position)) {}

    constexpr explicit operator bool() const { return bits_ != empty; }
    constexpr std::size_t kind() const { return bits_ >> 27; }
    constexpr std::size_t position() const { return bits_ & max_position; }
    /// The element of the same type that comes `count` after this one.
    constexpr TypedIndex next(std::uint32_t count) const {
        TypedIndex result;
        result.bits_ = bits_ + count;
        return result;
    }

private:
    static constexpr std::uint32_t empty = 0xffffffffu;
    std::uint32_t bits_ = empty;
};

/// Which material a surface has, and bits about it.
class MaterialIndex {
public:
    static constexpr std::size_t max_position = TypedIndex::max_position >> 3;
    static constexpr std::size_t both_sides = max_position + 1;  ///< the back looks like the front
    static constexpr std::size_t through = 2 * both_sides;  ///< light that comes from one side can matter on the other
    static constexpr std::size_t varying = 4 * both_sides;  ///< the surface model differs from place to place

    constexpr MaterialIndex() : MaterialIndex(0, 0) {}
    /// `kind` at most `TypedIndex::max_kind`, `position` at most `max_position`; unchecked. `flags` are summed up.
    constexpr MaterialIndex(std::size_t kind, std::size_t position, std::size_t flags = 0)
        : index_(kind, position | flags) {}

    constexpr std::size_t kind() const { return index_.kind(); }
    constexpr std::size_t position() const { return index_.position() & max_position; }
    constexpr std::size_t flags() const { return index_.position() & ~max_position; }
    constexpr bool two_sided() const { return (index_.position() & both_sides) != 0; }
    constexpr bool lit_through() const { return (index_.position() & through) != 0; }
    constexpr bool varies() const { return (index_.position() & varying) != 0; }

private:
    TypedIndex index_;
};

}  // namespace lightswitch
