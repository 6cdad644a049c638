#pragma once

// What is wrong with a scene file, gathered while it is read.

#include <lightswitch/core/error.hpp>
#include <lightswitch/load/mesh_file.hpp>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// Whether a scene file that cannot be honoured as a whole is refused, or read with stand-ins.
enum class Strictness { strict, lenient };

/// Something in a scene file that cannot be honoured.
struct Problem {
    std::string text;     ///< one line that begins with file, line and element
    std::string instead;  ///< what a lenient reading does, such as "it is left out"
};
using Problems = std::vector<Problem>;

/// Thrown by a strict reading: its message is the text of the first problem.
class UnsupportedScene : public Error {
public:
    explicit UnsupportedScene(Problems problems)
        : Error(problems.at(0).text), problems_(std::make_shared<const Problems>(std::move(problems))) {}
    /// All of them, in the order of reading.
    const Problems& problems() const { return *problems_; }

private:
    std::shared_ptr<const Problems> problems_;  // shared, since exceptions are copied without fail
};

namespace detail {

/// Takes down the problems, notices and files of one reading, each once. Everything that fails in a scene file comes
/// through here: a reader throws `Error`, and `attempt` around it says what happens then.
class ReadingLog {
public:
    void problem(std::string text, std::string instead) {
        if (problems_.size() < most && said_.insert(text).second)
            problems_.push_back({std::move(text), std::move(instead)});
    }
    void problem(const Origin& where, const std::string& what, std::string instead) {
        problem(where.prefix() + what, std::move(instead));
    }
    void notice(std::string text) {
        if (notices_.size() < most && said_.insert(text).second) notices_.push_back(std::move(text));
    }
    void notice(const Origin& where, const std::string& what) { notice(where.prefix() + what); }

    /// What `read()` returns. Where it throws an `Error`, that is a problem, `instead` says what is done, and
    /// `stand_in()` does it.
    template <class Read, class StandIn>
    auto attempt(const char* instead, Read&& read, StandIn&& stand_in) -> decltype(read()) {
        try {
            return read();
        } catch (const Error& error) {
            problem(error.what(), instead);
        }
        return stand_in();
    }
    /// The same where there is nothing to do instead.
    template <class Read>
    void attempt(const char* instead, Read&& read) {
        attempt(instead, read, [] {});
    }

    /// A file that was opened, whether or not it could be read.
    void file(const std::string& path) {
        if (known_files_.insert(path).second) files_.push_back(path);
    }

    /// Each file once, in the order of reading.
    const std::vector<std::string>& files() const { return files_; }
    const Problems& problems() const { return problems_; }
    const Notices& notices() const { return notices_; }

private:
    static constexpr std::size_t most = 10'000;  ///< a hostile file could have as many as it has bytes

    Problems problems_;
    Notices notices_;
    std::set<std::string> said_, known_files_;
    std::vector<std::string> files_;
};

}  // namespace detail
}  // namespace lightswitch
