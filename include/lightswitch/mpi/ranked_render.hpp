#pragma once

// How the ranks of an MPI job share one render, whatever its types.

#include <lightswitch/mpi/rank_session.hpp>
#include <lightswitch/mpi/ranks.hpp>
#include <lightswitch/mpi/shares.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

namespace detail {

/// The render of all ranks.
class RankedRender {
public:
    RankedRender(Ranks& ranks, RankSession session, const Budget& budget, const RankOptions& options)
        : ranks_(ranks), session_(std::move(session)), budget_(budget), options_(options) {
        if (budget_.samples == 0 && budget_.seconds == 0 && budget_.error == 0) budget_.samples = 64;
    }

    RankReport run() {
        ranks_.agree(try_to([&] { check(budget_); }));
        ranks_.agree(difference_from_root());
        before_ = ranks_.all(session_.made().count()).front();
        seconds_before_ = ranks_.all(session_.statistics().seconds).front();
        made_ = IterationSet(
            of_root(session_.made().ranges(), &IterationRange::seed, &IterationRange::begin, &IterationRange::end));
        total_ = gathered_ = before_;
        refuse_other_machines();
        if (budget_.error > 0) judged_at_ = std::max<std::uint64_t>(total_, 16);
        begin_ = Clock::now();
        while (!done_) {
            const std::uint64_t left =
                std::min(left_of(budget_.samples > 0, wanted()), left_of(judged_at_ > 0, judged_at_));
            if (left == 0) {
                gather();
                judge();
                if (budget_.samples > 0 && total_ >= wanted()) done_ = true;
            } else {
                round(left);
            }
        }
        gather();
        RankReport report{.ranks = ranks_.size(), .gatherings = gatherings_};
        for (const std::uint64_t bytes : ranks_.all(ranks_.bytes_sent()))
            report.most_bytes_sent = std::max(report.most_bytes_sent, bytes);
        for (const double waited : ranks_.all(waited_))
            report.most_seconds_waited = std::max(report.most_seconds_waited, waited);
        return report;
    }

private:
    using Clock = std::chrono::steady_clock;
    static double since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

    /// What each rank says at the end of a round.
    struct Word {
        std::uint64_t first = 0, made = 0, rays = 0;
        double seconds = 0;  // of the round, without waiting
        double now = 0;
        bool stop = false, failed = false, gather = false;
    };

    static std::string try_to(const auto& f) {
        try {
            f();
        } catch (const std::exception& error) {
            return error.what()[0] != '\0' ? error.what() : "an error without a text";
        }
        return {};
    }

    std::uint64_t wanted() const { return static_cast<std::uint64_t>(budget_.samples); }
    std::uint64_t left_of(bool limited, std::uint64_t limit) const {
        if (!limited) return std::numeric_limits<std::uint64_t>::max();
        return limit > total_ ? limit - total_ : 0;
    }

    /// The rows that rank 0 has, on every rank.
    template <class T, class... Member>
    std::vector<T> of_root(std::vector<T> rows, Member T::*... members) const {
        std::string bytes;
        ArchiveWriter writer(bytes);
        keep_columns(writer, rows, members...);
        const std::string received = ranks_.of_root(bytes);
        ByteReader in(received, "rank 0");
        ArchiveReader reader(in);
        keep_columns(reader, rows, members...);
        return rows;
    }

    std::string difference_from_root() const {
        const std::vector<RenderFact> facts = of_root(session_.facts, &RenderFact::first, &RenderFact::second);
        const auto seeds = ranks_.all(session_.seed);
        const std::string difference = first_difference(session_.facts, facts);
        if (!difference.empty()) return "renders something else than rank 0: " + difference + " on rank 0";
        const auto own = static_cast<std::size_t>(ranks_.rank());
        if (!session_.has_history) return seeds[own] == seeds[0] ? "" : "has another seed than rank 0";
        return std::count(seeds.begin(), seeds.end(), seeds[own]) == 1
                   ? ""
                   : "iterations of " + session_.name + " go on from one another: every rank needs a seed of its own";
    }

    /// On other machines Embree may use other instructions, and the program may be built another way.
    void refuse_other_machines() const {
        if (ranks_.on_one_machine() || session_.has_history) return;
        std::uint64_t own = 0;
        ranks_.agree(try_to([&] { own = session_.checksum(session_.first_iteration); }));
        ranks_.agree(own == ranks_.all(own).front()
                         ? ""
                         : "makes other bits than rank 0: the scene's content is another, or the program was built "
                           "another way, or Embree uses other instructions here than there");
    }

    void round(std::uint64_t left) {
        const double seconds = since_begin_;
        const double time_left =
            budget_.seconds > 0 ? budget_.seconds - seconds_before_ - seconds : std::numeric_limits<double>::infinity();
        if (time_left <= 0 && total_ > 0) done_ = true;
        if (done_) return;
        // Long rounds cost less waiting. The last of a given time is shared out so that nobody exceeds it.
        double length = std::max(std::min(0.1 * seconds, options_.longest_round), 0.25);
        const bool in_time = time_left < 2 * length && rates_known();
        if (in_time) length = std::max(time_left, 0.0);
        const auto count = shares(rates_, length, left, in_time && total_ > 0);
        done_ = std::all_of(count.begin(), count.end(), [](std::uint64_t n) { return n == 0; });
        if (done_) return;

        const Clock::time_point start = Clock::now();
        const auto own = static_cast<std::size_t>(ranks_.rank());
        Word word;
        word.first = first_of(count);
        const std::uint64_t already = session_.film().iterations(), rays = session_.statistics().counts.rays;
        const std::string problem = try_to([&] {
            if (count[own] > 0) session_.run(word.first, length_[own]);
        });
        word.made = session_.film().iterations() - already;
        word.rays = session_.statistics().counts.rays - rays;
        word.seconds = since(start);
        word.now = since(begin_);
        word.stop = session_.stop.stop_requested();
        word.failed = !problem.empty();
        word.gather = ranks_.root() && options_.gather_when && options_.gather_when();
        const Clock::time_point arrived = Clock::now();
        const std::vector<Word> words = ranks_.all(word);
        waited_ += since(arrived);
        learn(words);
        if (std::any_of(words.begin(), words.end(), [](const Word& w) { return w.failed; })) ranks_.agree(problem);
        if (ranks_.root() && options_.observer) options_.observer(progress(), rays_);
        stopped_ = std::any_of(words.begin(), words.end(), [](const Word& w) { return w.stop; });
        done_ = stopped_;
        if (words[0].gather) gather();
    }

    bool rates_known() const {
        return std::all_of(rates_.begin(), rates_.end(), [](double rate) { return rate > 0; });
    }

    /// Where the iterations of this rank begin when every rank makes so many, and how many each gets: fewer where
    /// others have been made already, as in a render that goes on.
    std::uint64_t first_of(const std::vector<std::uint64_t>& count) {
        length_ = count;
        if (session_.has_history) return done_by_own_;
        std::uint64_t next = session_.first_iteration, own = next;
        for (std::size_t i = 0; i < count.size(); ++i) {
            next = made_.next(session_.seed, next);
            if (static_cast<int>(i) == ranks_.rank()) own = next;
            for (const IterationRange& range : made_.ranges())
                if (range.seed == session_.seed && range.begin > next)
                    length_[i] = std::min(length_[i], range.begin - next);
            next += length_[i];
        }
        return own;
    }

    void learn(const std::vector<Word>& words) {
        std::vector<IterationRange> ranges = made_.ranges();
        for (std::size_t i = 0; i < words.size(); ++i) {
            const Word& word = words[i];
            total_ += word.made;
            rays_ += word.rays;
            if (word.made == 0) continue;
            if (!session_.has_history) ranges.push_back({session_.seed, word.first, word.first + word.made});
            // The last round counts as much as all before: machines change their pace.
            const double rate = double(word.made) / std::max(word.seconds, 1e-6);
            rates_[i] = rates_[i] > 0 ? 0.5 * (rates_[i] + rate) : rate;
        }
        made_ = IterationSet(std::move(ranges));
        done_by_own_ += words[static_cast<std::size_t>(ranks_.rank())].made;
        since_begin_ = words[0].now;
    }

    Progress progress() const {
        double fraction = 0;
        if (needed_ > 0) fraction = double(total_) / needed_;
        if (budget_.samples > 0 && wanted() > before_)
            fraction = std::max(fraction, double(total_ - before_) / double(wanted() - before_));
        if (budget_.seconds > 0) fraction = std::max(fraction, (seconds_before_ + since_begin_) / budget_.seconds);
        fraction = std::min(fraction, 1.0);
        return {.iterations = total_,
                .seconds = seconds_before_ + since_begin_,
                .fraction = fraction,
                .seconds_left = seconds_left(since_begin_, fraction),
                .film = session_.film()};
    }

    /// Rank 0 gets the sums of all along a tree, in as many steps as the number of ranks has binary digits; the others
    /// go on with none.
    void gather() {
        if (total_ == gathered_) return;
        RenderState state = session_.state();
        const std::string method_state = state.method_state;
        std::string problem;
        for (int step = 1; step < ranks_.size(); step *= 2) {
            if (ranks_.rank() % (2 * step) != 0) {
                ranks_.send(problem.empty() ? message(state, problem) : "", ranks_.rank() - step);
                break;
            }
            if (ranks_.rank() + step >= ranks_.size()) continue;
            const std::string received = ranks_.receive(ranks_.rank() + step);
            if (problem.empty()) problem = try_to([&] { add(state, received); });
        }
        ranks_.agree(problem);
        gathered_ = total_;
        ++gatherings_;
        since_begin_ = since(begin_);
        if (ranks_.root()) {
            state.statistics.seconds = seconds_before_ + since_begin_;
            state.statistics.cancelled = stopped_;
        } else {
            state.film = Film(session_.film().width(), session_.film().height());
            state.iterations = {};
            state.statistics = {};
        }
        state.method_state = method_state;
        session_.restore(std::move(state));
        if (ranks_.root() && options_.gathered) options_.gathered(progress());
    }

    /// A state as a message; nothing where it could not be made, and one byte where there is nothing in it.
    static std::string message(const RenderState& state, std::string& problem) {
        std::string bytes = "-";
        if (state.film.iterations() > 0) problem = try_to([&] { bytes = bytes_of(state); });
        return problem.empty() ? bytes : "";
    }
    static void add(RenderState& state, const std::string& message) {
        if (message.empty()) throw Error("a rank before this one could not send what it has made");
        if (message.size() > 1) merge(state, state_from(message, {.file = "what a rank has sent"}));
    }

    /// After a gathering: whether the error is as small as asked for, or how many iterations will make it so.
    void judge() {
        if (judged_at_ == 0 || total_ < judged_at_) return;
        struct Verdict {
            std::uint64_t next = 0;
            double needed = 0;
        } verdict;
        if (ranks_.root()) {
            const double ratio = budget_.error / session_.film().relative_error();
            verdict.needed = double(total_) / (ratio * ratio);  // as the variance falls as one over the number
            const double next = std::min(std::ceil(verdict.needed), double(2 * total_));
            verdict.next = std::max(static_cast<std::uint64_t>(next), total_ + 1);
        }
        verdict = ranks_.all(verdict).front();
        judged_at_ = verdict.next;
        needed_ = verdict.needed;
        if (verdict.needed <= double(total_)) done_ = true;
    }

    Ranks& ranks_;
    RankSession session_;
    Budget budget_;
    const RankOptions& options_;
    IterationSet made_;  // by all ranks, where iterations do not depend on one another
    std::vector<double> rates_ = std::vector<double>(static_cast<std::size_t>(ranks_.size()));
    std::vector<std::uint64_t> length_;
    std::uint64_t before_ = 0, total_ = 0, gathered_ = 0, done_by_own_ = 0, rays_ = 0;
    std::uint64_t judged_at_ = 0;  // where the error is judged next; 0: nowhere. It is likely to be met at `needed_`.
    double seconds_before_ = 0, since_begin_ = 0, needed_ = 0, waited_ = 0;
    Clock::time_point begin_;
    int gatherings_ = 0;
    bool done_ = false, stopped_ = false;
};

}  // namespace detail

}  // namespace lightswitch
