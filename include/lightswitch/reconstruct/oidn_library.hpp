#pragma once

// Open Image Denoise 2, found when the program runs: the part of its C interface that is used here, in declarations of
// this library's own. Nothing of it is needed to build.

#include <lightswitch/core/error.hpp>

#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#if __has_include(<dlfcn.h>)
#include <dlfcn.h>
#define LIGHTSWITCH_HAS_DLOPEN 1
#else
#define LIGHTSWITCH_HAS_DLOPEN 0
#endif

namespace lightswitch::detail {

/// The functions, by the names that they have there without the prefix. Pointers to its objects are `void*`.
struct OidnLibrary {
    static constexpr int cpu_device = 1, float3_format = 3;

    void* (*NewDevice)(int type) = nullptr;
    void (*SetDeviceInt)(void* device, const char* name, int value) = nullptr;
    void (*SetDeviceBool)(void* device, const char* name, bool value) = nullptr;
    int (*GetDeviceInt)(void* device, const char* name) = nullptr;
    void (*CommitDevice)(void* device) = nullptr;
    int (*GetDeviceError)(void* device, const char** message) = nullptr;
    void (*ReleaseDevice)(void* device) = nullptr;
    void* (*NewFilter)(void* device, const char* type) = nullptr;
    void (*SetSharedFilterImage)(void* filter, const char* name, void* pixels, int format, std::size_t width,
                                 std::size_t height, std::size_t offset, std::size_t pixel_stride,
                                 std::size_t row_stride) = nullptr;
    void (*SetFilterBool)(void* filter, const char* name, bool value) = nullptr;
    void (*CommitFilter)(void* filter) = nullptr;
    void (*ExecuteFilter)(void* filter) = nullptr;
    void (*ReleaseFilter)(void* filter) = nullptr;

    std::string why_not;  ///< empty when the library is there

    /// The library that the environment variable LIGHTSWITCH_OIDN names, or else the system's. Found once; never
    /// closed, as its threads may outlive any use.
    static const OidnLibrary& get() {
        static const OidnLibrary& library = *new OidnLibrary(find());
        return library;
    }

private:
    static OidnLibrary find() {
        OidnLibrary library;
#if LIGHTSWITCH_HAS_DLOPEN
        const char* named = std::getenv("LIGHTSWITCH_OIDN");
        std::vector<std::string> names{"libOpenImageDenoise.so.2", "libOpenImageDenoise.2.dylib"};
        if (named && *named) names = {named};
        void* handle = nullptr;
        for (const std::string& name : names) {
            handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
            if (handle) break;
            const char* message = dlerror();
            if (library.why_not.empty()) library.why_not = message ? message : name + " cannot be loaded";
        }
        if (!handle) return library;
        library.why_not.clear();
        const auto bind = [&](auto& function, const char* name) {
            void* symbol = dlsym(handle, name);
            if (!symbol && library.why_not.empty()) library.why_not = std::string("it has no function ") + name;
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
        };
        bind(library.NewDevice, "oidnNewDevice");
        bind(library.SetDeviceInt, "oidnSetDeviceInt");
        bind(library.SetDeviceBool, "oidnSetDeviceBool");
        bind(library.GetDeviceInt, "oidnGetDeviceInt");
        bind(library.CommitDevice, "oidnCommitDevice");
        bind(library.GetDeviceError, "oidnGetDeviceError");
        bind(library.ReleaseDevice, "oidnReleaseDevice");
        bind(library.NewFilter, "oidnNewFilter");
        bind(library.SetSharedFilterImage, "oidnSetSharedFilterImage");
        bind(library.SetFilterBool, "oidnSetFilterBool");
        bind(library.CommitFilter, "oidnCommitFilter");
        bind(library.ExecuteFilter, "oidnExecuteFilter");
        bind(library.ReleaseFilter, "oidnReleaseFilter");
#else
        library.why_not = "this system has no dlopen";
#endif
        return library;
    }
};

}  // namespace lightswitch::detail
