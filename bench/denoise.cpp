// What denoising brings and where: the error of samples, of the denoised image, and of their mixture, over samples.
//
//   denoise [--denoiser own|oidn] [--method M] [--size N] [--samples N] [--reference N] [SCENE...]
//
// --help says what the columns are.

#include <lightswitch/compiled.hpp>
#include <lightswitch/lightswitch.hpp>
#include <lightswitch/reconstruct/denoise.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;

constexpr char help[] =
    R"(denoise [OPTION VALUE]... [SCENE...]: samples, denoised image and their mixture against a reference, one thread

  --denoiser NAME   own or oidn (own)
  --method NAME     (path-nee)
  --size N          width and height in pixels (128)
  --samples N       most samples per pixel; the least are 2, each row has 4 times as many as the one before (4096)
  --reference N     samples per pixel of the reference (8192)
  SCENE             stock scenes; all by default

relMSE is that of `compare`, but by two halves x and y of the reference, (image - x)(image - y) / (r^2 + 0.01), so
that the reference's own noise adds nothing to its expectation.

samples     relMSE of all samples' mean
denoised    of what the denoiser makes of them, over that of the samples: below 1 it is better
mixed       of the mixture, likewise
of better   mixed over the better of the two: 1.1 is 10 % worse than it
said        estimated error of the mixture (root mean square over the mean), over the true one
within 1/2  share of pixels whose error is within once and twice what the error map says
detail      mean share of detail that came from samples
contradict  share of the image, in percent, where denoiser and samples contradict each other
seconds     processor time of rendering, and of denoising (three times) and mixing
)";

struct Options {
    std::string denoiser = "own", method = "path-nee";
    int size = 128, samples = 4096, reference = 8192;
    std::vector<std::string> scenes;
};

struct Reference {
    ls::Image a, b, mean;
};

ls::Image mean_of(const ls::Image& a, const ls::Image& b) {
    ls::Image mean = a;
    for (std::size_t i = 0; i < mean.pixels().size(); ++i)
        mean.pixels()[i] = ls::Rgb(0.5 * (ls::DVec3(a.pixels()[i]) + ls::DVec3(b.pixels()[i])));
    return mean;
}

/// The mean over pixels and channels of the squared error, over that of the reference + `offset`, or as it is.
double error_of(const ls::Image& image, const Reference& reference, bool relative) {
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels().size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double x = double(image.pixels()[i][c]), r = double(reference.mean.pixels()[i][c]);
            const double square = (x - double(reference.a.pixels()[i][c])) * (x - double(reference.b.pixels()[i][c]));
            sum += relative ? square / (r * r + 0.01) : square;
        }
    return sum / (3 * double(image.pixels().size()));
}

/// Share of the pixels that are off by at most `factor` times what the map says.
double covered(const ls::Mixed& mixed, const Reference& reference, double factor) {
    double inside = 0;
    for (std::size_t i = 0; i < mixed.image.pixels().size(); ++i) {
        const ls::DVec3 off = ls::DVec3(mixed.image.pixels()[i]) - ls::DVec3(reference.mean.pixels()[i]);
        inside += std::sqrt(glm::dot(off, off) / 3) <= factor * double(mixed.error.pixels()[i].x);
    }
    return inside / double(mixed.image.pixels().size());
}

template <ls::Reconstructor R>
void measure(const std::string& name, const R& reconstructor, const Options& options) {
    auto description = ls::stock::describe(name);
    if (!description) throw std::runtime_error("there is no stock scene " + name);
    description->film.resize(options.size, options.size);
    const ls::AnyScene any_scene = ls::build_any(*description);
    const ls::AnyMethod any_method = ls::method_by_name(options.method);
    const ls::TbbExecutor executor(1);
    std::printf("%s, %s, %s, %d x %d\n", name.c_str(), options.method.c_str(), R::name.data(), options.size,
                options.size);
    std::printf("  spp   samples  denoised   mixed  of better   said  within 1/2  detail  contradict   seconds\n");
    std::visit(
        [&](const auto& scene, const auto& method) {
            using Session = ls::detail::AnySession;
            ls::Guides guides = ls::render_guides(scene, 64, {.threads = 1});
            if constexpr (requires { reconstructor.prepare(guides); }) guides = reconstructor.prepare(guides);
            const auto make = [&](std::uint64_t seed) {
                return Session::make(scene, method, {.seed = seed, .threads = 1});
            };
            const Session reference_a = make(71), reference_b = make(72), a = make(1), b = make(2);
            reference_a.run({.samples = options.reference / 2}, {});
            reference_b.run({.samples = options.reference / 2}, {});
            Reference reference{reference_a.image(), reference_b.image(), {}};
            reference.mean = mean_of(reference.a, reference.b);
            const double level = (reference.mean.mean().x + reference.mean.mean().y + reference.mean.mean().z) / 3;
            double seconds = 0;
            for (int n = 1; 2 * n <= options.samples; n *= 4) {
                seconds += bench::seconds_of([&] {
                    a.run({.samples = n}, {});
                    b.run({.samples = n}, {});
                });
                const ls::Image of_a = a.image(), of_b = b.image(), both = mean_of(of_a, of_b);
                const ls::Image variance_a = n < 4 ? ls::Image() : a.film().variance();
                const ls::Image variance_b = n < 4 ? ls::Image() : b.film().variance();
                ls::Image variance;
                if (n >= 4) {
                    variance = mean_of(variance_a, variance_b);
                    for (ls::Rgb& pixel : variance.pixels()) pixel *= 0.5f;
                }
                ls::Image denoised;
                ls::Mixed mixed;
                const double more = bench::seconds_of([&] {
                    const auto denoise = [&](const ls::Image& image, const ls::Image& of_it) {
                        return reconstructor.reconstruct(ls::NoisyImage{image, of_it, guides}, executor);
                    };
                    denoised = denoise(both, variance);
                    const ls::Image denoised_a = denoise(of_a, variance_a), denoised_b = denoise(of_b, variance_b);
                    mixed = ls::mix({.a = of_a,
                                     .b = of_b,
                                     .denoised_a = denoised_a,
                                     .denoised_b = denoised_b,
                                     .denoised = denoised},
                                    executor);
                });
                const double raw = error_of(both, reference, true), other = error_of(denoised, reference, true);
                const double mix = error_of(mixed.image, reference, true);
                const double truth = std::sqrt(std::max(error_of(mixed.image, reference, false), 0.0)) / level;
                std::printf(
                    "%5d  %.2e    %6.4f  %6.4f      %5.3f  %5.2f  %.2f / %.2f   %5.3f      %6.2f  %.2f + %.2f\n", 2 * n,
                    raw, other / raw, mix / raw, mix / std::min(raw, other), mixed.relative_error / truth,
                    covered(mixed, reference, 1), covered(mixed, reference, 2), mixed.detail_from_samples,
                    mixed.contradiction ? 100 * mixed.contradiction->share : 0, seconds, more);
                std::fflush(stdout);
            }
        },
        any_scene, any_method);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    try {
        for (int i = 1; i < argc; ++i) {
            const std::string word = argv[i];
            if (word == "--help") return std::fputs(help, stdout) < 0;
            if (word.rfind("--", 0) != 0) {
                options.scenes.push_back(word);
                continue;
            }
            if (++i == argc) throw std::runtime_error(word + " needs a value");
            if (word == "--denoiser") options.denoiser = argv[i];
            else if (word == "--method") options.method = argv[i];
            else if (word == "--size") options.size = std::stoi(argv[i]);
            else if (word == "--samples") options.samples = std::stoi(argv[i]);
            else if (word == "--reference") options.reference = std::stoi(argv[i]);
            else throw std::runtime_error("there is no option " + word);
        }
        if (options.scenes.empty()) options.scenes.assign(ls::stock::names.begin(), ls::stock::names.end());
        for (const std::string& scene : options.scenes) {
            if (options.denoiser == "oidn") measure(scene, ls::Oidn(1), options);
            else measure(scene, ls::Regression{}, options);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
