// How fast mesh files are read: megabytes of the file per second of processor time, and the most memory that was taken.
//
//   load FILE.obj|FILE.ply|FILE.stl ...
//
// Each file is read 9 times, by a process of its own, on one thread, from the system's cache. best and median of the
// rates; peak: memory of the process at its highest, beside what the file has and what the mesh keeps.

#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>
#include <lightswitch/load/stl.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;

ls::Mesh load(const std::filesystem::path& path) {
    const std::string ending = ls::detail::lower_case(path.extension().string());
    if (ending == ".ply") return ls::load_ply(path);
    if (ending == ".stl") return ls::load_stl(path);
    return ls::load_obj(path);
}

std::size_t bytes(const ls::Mesh& mesh) {
    return mesh.positions.size() * sizeof mesh.positions[0] + mesh.normals.size() * sizeof mesh.normals[0] +
           mesh.uvs.size() * sizeof mesh.uvs[0] + mesh.triangles.size() * sizeof mesh.triangles[0];
}

void measure(const std::filesystem::path& path) {
    constexpr int runs = 9;
    const double megabytes = double(std::filesystem::file_size(path)) * 1e-6;
    std::vector<double> rates;
    double kept = 0;
    for (int i = 0; i < runs; ++i) {
        ls::Mesh mesh;
        rates.push_back(megabytes / bench::seconds_of([&] { mesh = load(path); }));
        kept = double(bytes(mesh)) * 1e-6;
    }
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const bench::Spread spread(rates);
    std::printf("%-24s %9.1f %9.1f %9.1f %9.1f %9.1f\n", path.filename().c_str(), megabytes,
                *std::max_element(rates.begin(), rates.end()), spread.median, double(usage.ru_maxrss) * 1.024e-3, kept);
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%-24s %9s %9s %9s %9s %9s\n", "file", "MB", "best MB/s", "median", "peak MB", "mesh MB");
    int failed = 0;
    for (int i = 1; i < argc; ++i) {
        std::fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            try {
                measure(argv[i]);
                std::fflush(stdout);
            } catch (const std::exception& error) {
                std::fprintf(stderr, "load: %s\n", error.what());
                _exit(2);
            }
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        failed |= status;
    }
    return failed ? 2 : 0;
}
