#pragma once

// What libFuzzer's targets share: bytes become a file, and a reader reads it. Only `Error` may come out of that.

#include "support/folder.hpp"

#include <lightswitch/core/error.hpp>

#include <cstdint>
#include <string>

namespace lightswitch::test {

/// Where this process writes its files.
inline const Folder& fuzz_folder() {
    static const Folder folder;
    return folder;
}

/// Calls `read(path)` with a file of that name.
inline int read_bytes(const std::uint8_t* data, std::size_t size, const std::string& name, const auto& read) {
    try {
        read(fuzz_folder().write(name, {reinterpret_cast<const char*>(data), size}));
    } catch (const Error&) {
    }
    return 0;
}

}  // namespace lightswitch::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
