#pragma once

// The sub-commands of the program `lightswitch`, and what the command line says to them.

#include <lightswitch/film/filter.hpp>
#include <lightswitch/method/extra_outputs.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/build.hpp>
#include <lightswitch/sweep/sweep_options.hpp>
#include <lightswitch/verify/verify.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch::program {

/// Exit statuses.
enum Status { success = 0, disagrees = 1, user_error = 2, undecided = 3, cancelled = 130 };

/// The size of an image in pixels.
struct Size {
    int width = 0, height = 0;
};

/// Which scene, and how it is built.
struct SceneOptions {
    std::string scene;  ///< a file, see `is_scene_file`, or the name of a stock scene
    std::map<std::string, std::string> defines;
    std::vector<std::filesystem::path> search_paths;  ///< where files are that are not beside the scene
    std::string sensor;                               ///< id or number; empty: the first one
    bool lenient = false;                             ///< stand-ins for what is not supported
    std::optional<Size> size;                         ///< instead of what the scene says
    int shrink_to = 0;             ///< where `size` is not given, the longest side in pixels; 0: as the scene says
    std::optional<Filter> filter;  ///< instead of what the scene says
    BuildOptions build;
};

/// Settings that only some methods have. What is not given stays as the method has it.
struct MethodOptions {
    std::optional<float> radius;         ///< pixels, of photon and vcm
    std::optional<float> alpha;          ///< of the same
    std::optional<double> photon_paths;  ///< light paths per pixel and iteration, of photon
    std::optional<bool> final_gather;    ///< of photon
    std::optional<int> bootstrap;        ///< paths, of mlt as what is below
    std::optional<float> mutations;      ///< per pixel and iteration
    std::optional<bool> refine;
};

/// The number-th of so many shares of a render's iterations; from 1.
struct Share {
    int number = 1, of = 1;
};

struct RenderOptions {
    SceneOptions scene;
    std::string method = "path-nee";
    MethodOptions of_method;
    std::vector<std::filesystem::path> outputs;
    std::vector<ExtraOutput> extra;  ///< layers of the outputs that can hold them; no two of one name
    std::string denoise;             ///< which denoiser (`denoiser_names`); empty: none
    std::string stats;               ///< a file, "-" for standard output, or empty
    Budget budget;                   ///< without any limit: what the scene says, or 64 samples
    std::optional<int> max_depth, rr_depth;
    std::uint64_t seed = 0;
    int threads = 0;
    Sampling sampling = Sampling::sobol;
    std::optional<float> exposure;     ///< stops; nothing: what the scene says, or chosen by the image
    bool auto_exposure = false;        ///< by the image, whatever the scene says
    std::filesystem::path checkpoint;  ///< from which the render goes on, and to which it is written; may be empty
    double every = 60;                 ///< seconds between two writings of it
    double write_every = 0;            ///< seconds between two writings of the images; 0: at the end alone
    std::optional<Share> share;
    bool quiet = false;
};

struct MergeOptions {
    std::vector<std::filesystem::path> states, outputs;
    std::filesystem::path checkpoint;  ///< may be empty
    std::optional<float> exposure;     ///< stops; nothing: chosen by the image
    bool quiet = false;
};

struct CompareOptions {
    std::vector<std::filesystem::path> images;
    std::filesystem::path reference;  ///< where it is empty, the last of the images
    std::vector<std::filesystem::path> outputs;
    std::filesystem::path report;  ///< may be empty
    bool absolute = false;
    float scale = 0;  ///< 0: chosen by the image
};

struct VerifyCommand {
    SceneOptions scene;  ///< may be empty where `against` is given
    std::vector<std::string> methods;
    std::string reference;
    MethodOptions of_methods;                  ///< each for those that have it
    std::vector<std::string> images, against;  ///< patterns of file names
    std::optional<int> max_depth;
    VerifyOptions options{.seconds = 60};
    std::string report, json;  ///< files, or empty; `json` may be "-"
    bool quiet = false;
};

struct SweepCommand {
    SceneOptions scene;
    std::vector<std::string> methods;  ///< without any: all that have an error
    MethodOptions of_methods;          ///< each for those that have it
    std::filesystem::path reference;   ///< an image; where it is empty, one is made
    std::optional<int> max_depth;
    SweepOptions options{.seconds = 0.25};
    std::string report, csv;  ///< files, or empty; `csv` may be "-"
    bool quiet = false;
};

struct ViewOptions {
    SceneOptions scene;
    std::string method = "path-nee", against;  ///< names; the second may be empty
    MethodOptions of_methods;                  ///< each for those that have it
    std::optional<int> max_depth, rr_depth;
    int samples = 0;  ///< after which a method rests; 0: it never does
    std::uint64_t seed = 0;
    int threads = 0;
    Sampling sampling = Sampling::sobol;
    std::optional<float> exposure;  ///< stops; nothing: what the scene says, or chosen by the first image
    Size window{1280, 800};
    double seconds = 0;  ///< after which the window closes; 0: never
    std::string stats;   ///< a file, "-" for standard output, or empty
    bool quiet = false;
};

inline constexpr int most_strategy_depth = 16;  ///< then there are 151 of them

struct StrategiesCommand {
    SceneOptions scene;
    std::vector<std::filesystem::path> outputs;
    std::string directory;  ///< for an image of each; may be empty
    int max_depth = 5, samples = 64, threads = 0;
    std::uint64_t seed = 0;
    bool unweighted = false, quiet = false;
};

/// A pixel, counted from 0 at the top left.
struct PixelAt {
    int x = 0, y = 0;
};

struct ReplayCommand {
    SceneOptions scene;
    std::string method = "path-nee";
    MethodOptions of_method;
    std::optional<PixelAt> pixel;
    std::uint64_t iteration = 0, brightest = 0;  ///< of so many the brightest instead, unless that is 0
    std::optional<int> max_depth, rr_depth;
    std::uint64_t seed = 0;
    int threads = 0;
    Sampling sampling = Sampling::sobol;
    bool own = false;  ///< without what paths of other pixels splat
    std::string json;  ///< a file, "-" for standard output, or empty
    bool quiet = false;
};

// Each runs one sub-command and returns the program's exit status. They throw `Error` for what the user can mend.
int render(const RenderOptions& options);
int merge(const MergeOptions& options);
int compare(const CompareOptions& options);
int verify(const VerifyCommand& command);
int strategies(const StrategiesCommand& command);
int sweep(const SweepCommand& command);
int view(const ViewOptions& options);
int replay(const ReplayCommand& command);
int info(const SceneOptions& options);
int list_methods();

}  // namespace lightswitch::program
