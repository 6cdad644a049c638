#include "ranks.hpp"

#include "messages.hpp"

#include <lightswitch/core/error.hpp>

#if LIGHTSWITCH_HAS_MPI
#include <lightswitch/mpi/ranks.hpp>
#endif

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace lightswitch::program {
namespace {

bool have_met = false;

/// How many processes a job says that it has started; 1 without a job.
[[maybe_unused]] int started_together() {
    int count = 1;
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* const text = std::getenv(name)) count = std::max(count, std::atoi(text));
    return count;
}

#if LIGHTSWITCH_HAS_MPI
std::unique_ptr<Ranks> job;

/// Without a job MPI would start one of its own, which takes longer than many a render.
bool started_by_job() {
    const auto set = [](const char* name) { return std::getenv(name) != nullptr; };
    return set("OMPI_COMM_WORLD_SIZE") || set("PMI_SIZE") || set("PMI_RANK") || set("PMIX_RANK");
}
#endif

}  // namespace

#if LIGHTSWITCH_HAS_MPI

MpiJob::MpiJob(int& argc, char**& argv) {
    if (!started_by_job()) return;
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    job = std::make_unique<Ranks>(MPI_COMM_WORLD);
    if (is_root()) return;
    silence_messages();
    if (std::freopen("/dev/null", "w", stdout) == nullptr) std::fclose(stdout);
}

MpiJob::~MpiJob() {
    if (!job) return;
    job.reset();
    MPI_Finalize();
}

Ranks* ranks() { return job.get(); }
int rank_count() { return job ? job->size() : 1; }
bool is_root() { return !job || job->root(); }
void agree(const std::string& problem) {
    if (job) job->agree(problem);
    else if (!problem.empty()) throw Error(problem);
}

void meet() {
    have_met = true;
    agree("");
}

#else

MpiJob::MpiJob(int&, char**&) {}
MpiJob::~MpiJob() = default;
Ranks* ranks() { return nullptr; }
int rank_count() { return 1; }
bool is_root() { return true; }
void agree(const std::string& problem) {
    if (!problem.empty()) throw Error(problem);
}

void meet() {
    have_met = true;
    if (started_together() > 1)
        throw Error(
            fmt::format("this program was built without MPI: each of the {} processes would render the whole. Build it "
                        "where MPI is installed (Debian, Ubuntu: libopenmpi-dev), or give each a share with --part",
                        started_together()));
}

#endif

std::string last_words(const std::string& problem) {
    if (have_met || rank_count() == 1) return problem;
    have_met = true;
    try {
        agree(problem);
    } catch (const std::exception& error) {
        return error.what();
    }
    return problem;
}

}  // namespace lightswitch::program
