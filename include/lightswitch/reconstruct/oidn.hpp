#pragma once

// Open Image Denoise as a reconstructor.

#include <lightswitch/reconstruct/oidn_library.hpp>
#include <lightswitch/reconstruct/reconstructor.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lightswitch {

/// Intel's Open Image Denoise 2, a neural network, on the processor. Loaded when it is first asked for: the library
/// that the environment variable LIGHTSWITCH_OIDN names, or else libOpenImageDenoise.so.2 of the system.
///
/// Copies share the device. It may be used from one thread at a time.
class Oidn {
public:
    static constexpr std::string_view name = "oidn";

    /// Why there is none; nothing where there is.
    static std::optional<std::string> why_not() {
        const std::string& reason = detail::OidnLibrary::get().why_not;
        return reason.empty() ? std::nullopt : std::optional(reason);
    }

    /// On so many threads (0: as many as the machine has). Throws `Error` where there is no Open Image Denoise 2.
    explicit Oidn(int threads = 0) {
        if (const auto reason = why_not())
            throw Error("Open Image Denoise 2 is not to be had (" + *reason +
                        "): install it, or name its library in the environment variable LIGHTSWITCH_OIDN");
        device_ = {library().NewDevice(detail::OidnLibrary::cpu_device), [](void* device) {
                       if (device) library().ReleaseDevice(device);
                   }};
        if (!device_) fail("no device");
        if (threads > 0) library().SetDeviceInt(device_.get(), "numThreads", threads);
        library().SetDeviceBool(device_.get(), "setAffinity", false);  // threads of others run here, too
        library().CommitDevice(device_.get());
        check_errors();
    }

    /// Its version, such as "2.5.1".
    std::string version() const {
        const auto part = [&](const char* which) {
            return std::to_string(library().GetDeviceInt(device_.get(), which));
        };
        return part("versionMajor") + "." + part("versionMinor") + "." + part("versionPatch");
    }

    /// Guides with their own noise taken out, as its documentation advises for what is out of focus or in motion.
    Guides prepare(const Guides& guides) const {
        Guides clean;
        if (!guides.albedo.empty()) clean.albedo = filter(guides.albedo, "albedo", nullptr);
        if (!guides.normal.empty()) clean.normal = filter(guides.normal, "normal", nullptr);
        return clean;
    }

    Image reconstruct(const NoisyImage& noisy, const Executor auto&) const {
        detail::check(noisy);
        // Powers of two change no digit; the network's own range is that of half-precision numbers.
        const auto scale = static_cast<float>(detail::unit_scale(noisy.image));
        Image scaled(noisy.image.width(), noisy.image.height());
        for (std::size_t i = 0; i < scaled.pixels().size(); ++i) scaled.pixels()[i] = noisy.image.pixels()[i] * scale;
        Image result = filter(scaled, "color", &noisy.guides);
        for (Rgb& pixel : result.pixels()) pixel /= scale;
        return result;
    }

private:
    static const detail::OidnLibrary& library() { return detail::OidnLibrary::get(); }

    [[noreturn]] static void fail(const std::string& message) { throw Error("Open Image Denoise: " + message); }

    void check_errors() const {
        const char* message = nullptr;
        if (library().GetDeviceError(device_.get(), &message) != 0) fail(message ? message : "an error without a name");
    }

    Image filter(const Image& input, const char* input_name, const Guides* guides) const {
        const std::unique_ptr<void, void (*)(void*)> filter(library().NewFilter(device_.get(), "RT"),
                                                            [](void* f) { library().ReleaseFilter(f); });
        if (!filter) {
            check_errors();
            fail("no filter");
        }
        // The interface takes pointers that it may write to, and writes to the output alone.
        const auto set = [&](const char* which, const Image& image) {
            library().SetSharedFilterImage(filter.get(), which, const_cast<Rgb*>(image.pixels().data()),
                                           detail::OidnLibrary::float3_format, static_cast<std::size_t>(image.width()),
                                           static_cast<std::size_t>(image.height()), 0, sizeof(Rgb), 0);
        };
        Image output(input.width(), input.height());
        set(input_name, input);
        // Normals guide only beside albedo.
        const Image white = guides && guides->albedo.empty() && !guides->normal.empty() ? white_image(input) : Image();
        if (guides && !(guides->albedo.empty() && guides->normal.empty())) {
            set("albedo", guides->albedo.empty() ? white : guides->albedo);
            if (!guides->normal.empty()) set("normal", guides->normal);
            library().SetFilterBool(filter.get(), "cleanAux", true);
        }
        set("output", output);
        if (guides) library().SetFilterBool(filter.get(), "hdr", true);
        library().CommitFilter(filter.get());
        library().ExecuteFilter(filter.get());
        check_errors();
        return output;
    }

    static Image white_image(const Image& like) {
        Image image(like.width(), like.height());
        for (Rgb& pixel : image.pixels()) pixel = Rgb(1);
        return image;
    }

    std::shared_ptr<void> device_;
};

}  // namespace lightswitch
