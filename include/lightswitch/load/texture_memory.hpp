#pragma once

// How much memory the textures of a scene file may take.

#include <lightswitch/core/error.hpp>

#include <cstddef>

namespace lightswitch::detail {

/// Adds up the bitmaps of one scene file.
class TextureMemory {
public:
    static constexpr std::size_t most = std::size_t(1) << 34;

    /// Throws `Error`, of that place, when `bytes` more are too much; they do not count then.
    void add(std::size_t bytes, const Origin& where) {
        if (bytes > most - total_) fail(where, "the textures of the scene take more than 16 GiB");
        total_ += bytes;
    }

private:
    std::size_t total_ = 0;
};

}  // namespace lightswitch::detail
