#pragma once

// Processes that make one render together: the ranks of an MPI job, which mpirun or srun has started.

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>

namespace lightswitch {
class Ranks;
}

namespace lightswitch::program {

/// What it took to render together.
struct Sharing {
    int ranks = 1, gatherings = 0;
    std::uint64_t most_bytes_sent = 0;  ///< by any one rank
    double most_seconds_waited = 0;     ///< by any one rank, for the others
};

/// This process's part in a job, from the begin of `main` to its end. Where no job has started it, it is alone. All
/// ranks but the first say nothing.
class MpiJob {
public:
    MpiJob(int& argc, char**& argv);
    ~MpiJob();
    MpiJob(const MpiJob&) = delete;
    MpiJob& operator=(const MpiJob&) = delete;
};

/// Of the job; null when this process is alone.
Ranks* ranks();
int rank_count();
/// Whether it is this process that writes files and talks.
bool is_root();

/// Throws the same `Error` on all ranks when one or more have a problem, a text that is not empty. Every rank calls it.
void agree(const std::string& problem);

/// Where all ranks meet when they know what to do: behind it they fail together, or rank 0 alone.
void meet();
/// What is to be said of an error that ends this rank, as one text for all of them if they have not met.
std::string last_words(const std::string& problem);

/// What `f` returns, unless it throws on any rank: then it throws on all.
auto together(auto&& f) {
    std::optional<decltype(f())> result;
    std::string problem;
    try {
        result.emplace(f());
    } catch (const std::exception& error) {
        if (rank_count() == 1) throw;
        problem = error.what();
    }
    agree(problem);
    return std::move(*result);
}

}  // namespace lightswitch::program
