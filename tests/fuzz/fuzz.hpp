#pragma once

// What libFuzzer's targets share: bytes become a file, and a reader reads it. Only `Error` may come out of that.

#include <lightswitch/core/error.hpp>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace lightswitch::test {

/// The folder in which this process writes its files: in memory, if the system has such a place.
inline const std::filesystem::path& fuzz_folder() {
    static const std::filesystem::path folder = [] {
        std::string name = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
        name += "/lightswitch-fuzz-XXXXXX";
        if (mkdtemp(name.data()) == nullptr) std::abort();
        std::atexit([] { std::filesystem::remove_all(fuzz_folder()); });
        return std::filesystem::path(name);
    }();
    return folder;
}

inline std::filesystem::path write_fuzz_file(const std::string& name, const void* bytes, std::size_t size) {
    const std::filesystem::path path = fuzz_folder() / name;
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    return path;
}

/// Calls `read(path)` with a file of that name.
inline int read_bytes(const std::uint8_t* data, std::size_t size, const std::string& name, const auto& read) {
    try {
        read(write_fuzz_file(name, data, size));
    } catch (const Error&) {
    }
    return 0;
}

}  // namespace lightswitch::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
