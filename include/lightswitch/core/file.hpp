#pragma once

// Files read whole, and written so that a reader never sees half of one.

#include <lightswitch/core/error.hpp>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#define LIGHTSWITCH_MAPS_FILES 1
#else
#define LIGHTSWITCH_MAPS_FILES 0
#endif

namespace lightswitch {

namespace detail {

inline Origin file_origin(const std::filesystem::path& path) {
    Origin where;
    where.file = path.string();
    return where;
}

inline std::string errno_text(int code) { return std::generic_category().message(code); }

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

/// Whether what is written must be on the device before its name is.
enum class Flushed { no, yes };

/// Brings a directory's names to the device; where that is not possible, nothing is lost but certainty.
inline void flush_directory([[maybe_unused]] const std::filesystem::path& path) {
#if LIGHTSWITCH_MAPS_FILES
    const int directory = ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_CLOEXEC);
    if (directory < 0) return;
    ::fsync(directory);
    ::close(directory);
#endif
}

/// The name of a file that is to become `target`: ".NAME.tmp-" and sixteen hexadecimal digits.
inline std::string temporary_prefix(const std::filesystem::path& target) {
    return "." + target.filename().string().substr(0, 200) + ".tmp-";  // leaves room for the rest in 255 bytes
}

/// A new file beside `target` that takes its place on `commit()` and vanishes without it.
class TemporaryFile {
public:
    explicit TemporaryFile(std::filesystem::path target) : target_(std::move(target)) {
        std::random_device random;
        for (int attempt = 0; attempt < 16 && !file_; ++attempt) {
            std::array<char, 24> suffix{};
            std::snprintf(suffix.data(), suffix.size(), "%08x%08x", random(), random());
            path_ = target_.parent_path() / (temporary_prefix(target_) + suffix.data());
            file_.reset(std::fopen(path_.string().c_str(), "wbx"));  // x: never somebody else's file
            if (!file_ && errno != EEXIST) break;
        }
        if (!file_) fail(file_origin(target_), "cannot create a file in this directory: " + errno_text(errno));
    }

    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    ~TemporaryFile() {
        file_.reset();
        std::error_code ignored;
        if (!committed_) std::filesystem::remove(path_, ignored);
    }

    /// Writes everything, closes, and renames. Throws `Error` when any of it fails (a full disk may show only then).
    void commit(std::string_view bytes, Flushed flushed = Flushed::no) {
        errno = 0;
        bool ok = std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
        ok = ok && std::fflush(file_.get()) == 0;
#if LIGHTSWITCH_MAPS_FILES
        ok = ok && (flushed == Flushed::no || ::fsync(::fileno(file_.get())) == 0);
#endif
        int code = errno;
        if (std::fclose(file_.release()) != 0 && ok) {
            ok = false;
            code = errno;
        }
        if (!ok) fail(file_origin(target_), "writing failed, nothing is left behind: " + errno_text(code));
        std::error_code error;
        std::filesystem::rename(path_, target_, error);
        if (error) fail(file_origin(target_), "cannot put the finished file in place: " + error.message());
        committed_ = true;
        if (flushed == Flushed::yes) flush_directory(target_.parent_path());
    }

private:
    std::filesystem::path target_, path_;
    FileHandle file_;
    bool committed_ = false;
};

/// The file that writing to `path` replaces: links are followed, also to where nothing is yet, so that they stay links.
inline std::filesystem::path resolve_output(std::filesystem::path path) {
    std::error_code error;
    for (int links = 0; links < 40 && std::filesystem::is_symlink(path, error); ++links) {
        const auto next = std::filesystem::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / next;
    }
    return path;
}

/// Throws `Error` when a file of that name cannot be, as far as looking can tell.
inline void check_output_name(const std::filesystem::path& path) {
    const Origin where = file_origin(path);
    if (path.filename().empty()) fail(where, "names no file to write");
    std::error_code error;
    const auto target = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(target)) fail(where, "is a directory; name a file in it");
    if (std::filesystem::exists(target)) {
        if (!std::filesystem::is_regular_file(target)) fail(where, "is not a regular file and is not replaced");
        if (!FileHandle(std::fopen(path.string().c_str(), "rb+")))
            fail(where, "exists and may not be written: " + errno_text(errno));
    }
    const auto parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (std::filesystem::is_directory(parent, error)) return;
    if (std::filesystem::exists(parent, error)) fail(where, "'" + parent.string() + "' is not a directory");
    fail(where, "the directory '" + parent.string() + "' does not exist; create it first");
}

}  // namespace detail

/// Whether both names lead to one file, or would once it is written: whatever links, relative names and other spellings
/// lie between.
inline bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error)) return true;
    const auto place = [&](const std::filesystem::path& path) {
        const auto target = detail::resolve_output(path);
        const auto folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
        return std::filesystem::weakly_canonical(folder, error) / target.filename();
    };
    return place(a) == place(b);
}

/// Writes `bytes` to `path` so that the file is either complete or as it was before: to a temporary name in the same
/// directory, then by renaming. Replaces an existing file; a symbolic link keeps pointing to what is written.
///
/// Not flushed to the device: a power failure right after may lose it. Throws `Error` (missing directory, directory
/// instead of a file, no permission, full disk) and then leaves no temporary file. Calls for different paths may run
/// in parallel.
inline void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
    const auto target = detail::resolve_output(path);
    detail::check_output_name(target);
    detail::TemporaryFile(target).commit(bytes);
}

/// The same, and after a power failure, too, the file is either as it was or complete.
inline void write_file_durably(const std::filesystem::path& path, std::string_view bytes) {
    const auto target = detail::resolve_output(path);
    detail::check_output_name(target);
    detail::TemporaryFile(target).commit(bytes, detail::Flushed::yes);
}

/// Removes what writing to `path` has left behind where a process was killed meanwhile. Nobody may be writing to it.
inline void remove_leftovers(const std::filesystem::path& path) {
    const auto target = detail::resolve_output(path);
    const std::string prefix = detail::temporary_prefix(target);
    const auto folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
    std::error_code error;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        std::error_code ignored;
        if (name.starts_with(prefix) && name.size() == prefix.size() + 16 &&
            name.find_first_not_of("0123456789abcdef", prefix.size()) == std::string::npos)
            std::filesystem::remove(at->path(), ignored);
    }
}

/// Throws `Error` unless `write_file_atomically(path, ...)` can be expected to work. Creates a file in the directory
/// to find out, and removes it. Call it before the work whose result is to be written.
inline void check_file_writable(const std::filesystem::path& path) {
    const auto target = detail::resolve_output(path);
    detail::check_output_name(target);
    detail::TemporaryFile{target};
}

namespace detail {

/// Opens a regular file to read it. Throws `Error` when there is none, it cannot be read, or it exceeds `max_bytes`.
inline FileHandle open_file(const std::filesystem::path& path, std::uintmax_t max_bytes, std::size_t& size) {
    const Origin where = file_origin(path);
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail(where, "no such file");
    if (std::filesystem::is_directory(status)) fail(where, "is a directory, not a file");
    if (!std::filesystem::is_regular_file(status)) fail(where, "is not a regular file");
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error) fail(where, "cannot be read: " + error.message());
    if (bytes > max_bytes)
        fail(where, "has " + std::to_string(bytes) + " bytes; at most " + std::to_string(max_bytes) + " are read");
    FileHandle file(std::fopen(path.string().c_str(), "rb"));
    if (!file) fail(where, "cannot be read: " + errno_text(errno));
    size = static_cast<std::size_t>(bytes);
    return file;
}

}  // namespace detail

/// The bytes of a regular file. Throws `Error` when there is none, it cannot be read, or it exceeds `max_bytes`.
inline std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
    std::size_t size = 0;
    const detail::FileHandle file = detail::open_file(path, max_bytes, size);
    std::string bytes(size, '\0');
    if (std::fread(bytes.data(), 1, size, file.get()) != size) fail(detail::file_origin(path), "reading failed");
    return bytes;
}

/// The same without a copy of a large file, where the system can map it into memory. Nobody may shorten the file
/// meanwhile: the system would end the program.
class FileBytes {
public:
    FileBytes(const std::filesystem::path& path, std::uintmax_t max_bytes) {
#if LIGHTSWITCH_MAPS_FILES
        constexpr std::size_t large = std::size_t(1) << 20;
        std::size_t size = 0;
        const detail::FileHandle file = detail::open_file(path, max_bytes, size);
        if (size >= large) {
            void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, ::fileno(file.get()), 0);
            if (bytes != MAP_FAILED) mapped_ = {static_cast<const char*>(bytes), size};
        }
#endif
        if (mapped_.empty()) read_ = read_file(path, max_bytes);
    }
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;
    ~FileBytes() {
#if LIGHTSWITCH_MAPS_FILES
        if (!mapped_.empty()) ::munmap(const_cast<char*>(mapped_.data()), mapped_.size());
#endif
    }

    std::string_view view() const { return mapped_.empty() ? std::string_view(read_) : mapped_; }

private:
    std::string_view mapped_;
    std::string read_;
};

}  // namespace lightswitch
