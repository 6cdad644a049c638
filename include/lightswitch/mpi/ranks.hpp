#pragma once

// The processes of an MPI job, and what they say to one another. Needs an MPI library, such as Open MPI or MPICH.

#include <lightswitch/core/error.hpp>

// The library's C interface alone: nobody needs the bindings for C++ that MPI once had.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightswitch {

/// The ranks of a communicator. All members but the plain questions are collective or meet their counterpart: every
/// rank calls them in the same order, from one thread. MPI must have been initialised, and is finalised after the last
/// of these objects. An error of MPI itself, such as the death of a rank, ends the job (MPI_ERRORS_ARE_FATAL, unless
/// the communicator says otherwise).
class Ranks {
public:
    explicit Ranks(MPI_Comm communicator) {
        MPI_Comm_dup(communicator, &communicator_);  // so that no message meets one of the caller's
        MPI_Comm_rank(communicator_, &rank_);
        MPI_Comm_size(communicator_, &size_);
    }
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    ~Ranks() { MPI_Comm_free(&communicator_); }

    int rank() const { return rank_; }
    int size() const { return size_; }
    bool root() const { return rank_ == 0; }
    std::uint64_t bytes_sent() const { return bytes_sent_; }

    /// The value of every rank, by rank.
    template <class T>
    std::vector<T> all(const T& value) const {
        static_assert(std::is_trivially_copyable_v<T>);
        std::vector<T> values(static_cast<std::size_t>(size_));
        MPI_Allgather(&value, static_cast<int>(sizeof(T)), MPI_BYTE, values.data(), static_cast<int>(sizeof(T)),
                      MPI_BYTE, communicator_);
        return values;
    }
    /// The text of rank 0, on every rank.
    std::string of_root(std::string text) const {
        auto size = static_cast<std::uint64_t>(text.size());
        MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator_);
        text.resize(size);
        for (std::size_t done = 0; done < text.size(); done += most_at_once)
            MPI_Bcast(text.data() + done, static_cast<int>(std::min(most_at_once, text.size() - done)), MPI_BYTE, 0,
                      communicator_);
        return text;
    }
    void send(const std::string& bytes, int to) {
        const auto size = static_cast<std::uint64_t>(bytes.size());
        MPI_Send(&size, 1, MPI_UINT64_T, to, 0, communicator_);
        for (std::size_t done = 0; done < bytes.size(); done += most_at_once)
            MPI_Send(bytes.data() + done, static_cast<int>(std::min(most_at_once, bytes.size() - done)), MPI_BYTE, to,
                     0, communicator_);
        bytes_sent_ += size;
    }
    std::string receive(int from) const {
        std::uint64_t size = 0;
        MPI_Recv(&size, 1, MPI_UINT64_T, from, 0, communicator_, MPI_STATUS_IGNORE);
        std::string bytes(size, '\0');
        for (std::size_t done = 0; done < bytes.size(); done += most_at_once)
            MPI_Recv(bytes.data() + done, static_cast<int>(std::min(most_at_once, bytes.size() - done)), MPI_BYTE, from,
                     0, communicator_, MPI_STATUS_IGNORE);
        return bytes;
    }

    /// Throws the same `Error` on every rank when one or more have a problem (a text that is not empty): it names the
    /// ranks and their machines, or none where all have the same.
    void agree(const std::string& problem) const {
        constexpr std::size_t most = 2000;
        struct Text {
            char problem[most + 1] = {}, machine[MPI_MAX_PROCESSOR_NAME + 1] = {};
        } mine;
        problem.copy(mine.problem, most);
        int length = 0;
        MPI_Get_processor_name(mine.machine, &length);
        const std::vector<Text> texts = all(mine);
        const auto same = [&](const Text& t) { return std::string(t.problem) == texts.front().problem; };
        if (std::all_of(texts.begin(), texts.end(), same)) {
            if (texts.front().problem[0] != '\0') throw Error(texts.front().problem);
            return;
        }
        std::string message;
        for (std::size_t i = 0; i < texts.size(); ++i)
            if (texts[i].problem[0] != '\0')
                message += (message.empty() ? "rank " : "; rank ") + std::to_string(i) + " (" + texts[i].machine +
                           "): " + texts[i].problem;
        throw Error(message);
    }

    /// Whether all ranks run on one machine.
    bool on_one_machine() const {
        MPI_Comm here = MPI_COMM_NULL;
        MPI_Comm_split_type(communicator_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
        int count = 1;
        MPI_Comm_size(here, &count);
        MPI_Comm_free(&here);
        return all(count).front() == size_;
    }

    /// How many threads this rank may use so that all ranks of a machine use each processor once that they may run on;
    /// 0 where the system does not say.
    int fair_threads() const {
        int threads = 0;
#if defined(__linux__)
        struct Processors {
            char machine[MPI_MAX_PROCESSOR_NAME + 1] = {};
            cpu_set_t processors;
        } mine;
        int length = 0;
        MPI_Get_processor_name(mine.machine, &length);
        CPU_ZERO(&mine.processors);
        if (sched_getaffinity(0, sizeof mine.processors, &mine.processors) != 0) CPU_ZERO(&mine.processors);
        const std::vector<Processors> everyone = all(mine);
        double share = 0;
        for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
            if (!CPU_ISSET(cpu, &mine.processors)) continue;
            share += 1.0 / double(std::count_if(everyone.begin(), everyone.end(), [&](const Processors& other) {
                         return CPU_ISSET(cpu, &other.processors) && std::string_view(other.machine) == mine.machine;
                     }));
        }
        threads = share > 0 ? std::max(1, static_cast<int>(share + 1e-6)) : 0;
#endif
        return threads;
    }

private:
    static constexpr std::size_t most_at_once = std::size_t{1} << 30;  // as MPI counts in int

    MPI_Comm communicator_ = MPI_COMM_NULL;
    int rank_ = 0, size_ = 1;
    std::uint64_t bytes_sent_ = 0;
};

}  // namespace lightswitch
