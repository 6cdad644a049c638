#pragma once

// Running the program `lightswitch` as its users do: as a process of its own, in an empty directory.

#include "support/folder.hpp"
#include "support/paths.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lightswitch::test {

inline std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// How a process ended.
struct Ended {
    int status = -1;  ///< exit status; -1 when a signal ended it
    std::string out, err;

    bool says(const std::string& text) const { return err.find(text) != std::string::npos; }
    bool prints(const std::string& text) const { return out.find(text) != std::string::npos; }
};

/// The program at work in a directory.
class Process {
public:
    /// `standard_output` names a file to use instead of keeping the output, "" to close the stream. `prepare` is called
    /// in the new process, and tells whether it may go on; where it may not, the status is 127.
    Process(const Folder& workspace, std::vector<std::string> arguments, const char* standard_output = nullptr,
            const std::function<bool()>& prepare = {}) {
        std::string program = test::program();
        std::vector<char*> words{program.data()};
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        const std::string out = standard_output ? standard_output : (streams_ / "out").string();
        const std::string err = (streams_ / "err").string();
        id_ = fork();
        REQUIRE(id_ >= 0);
        if (id_ > 0) return;
        // What the test itself inherited must not reach the program; and it does not outlive the test for long.
        std::signal(SIGINT, SIG_DFL);
        std::signal(SIGTERM, SIG_DFL);
        alarm(120);
        const bool ready =
            chdir(workspace.path().c_str()) == 0 && redirect("/dev/null", O_RDONLY, STDIN_FILENO) &&
            (out.empty() ? close(STDOUT_FILENO) == 0 : redirect(out, O_WRONLY | O_CREAT, STDOUT_FILENO)) &&
            redirect(err, O_WRONLY | O_CREAT, STDERR_FILENO) && (!prepare || prepare());
        if (ready) execv(program.c_str(), words.data());
        _exit(127);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void signal(int number) const { kill(id_, number); }
    bool runs() const {
        siginfo_t ended{};
        return waitid(P_PID, static_cast<id_t>(id_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
    }

    Ended wait() {
        int status = 0;
        REQUIRE(waitpid(id_, &status, 0) == id_);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(streams_ / "out"), read_text(streams_ / "err")};
    }

private:
    static bool redirect(const std::string& path, int flags, int stream) {
        const int file = open(path.c_str(), flags, 0600);
        return file >= 0 && dup2(file, stream) == stream && (file == stream || close(file) == 0);
    }

    Folder streams_;
    pid_t id_ = -1;
};

/// Runs the program to its end.
inline Ended run(const Folder& workspace, const std::vector<std::string>& arguments) {
    return Process(workspace, arguments).wait();
}

/// True when an error message of one line, and nothing else, came with the exit status for errors.
inline bool is_user_error(const Ended& ended) {
    return ended.status == 2 && ended.out.empty() && ended.err.starts_with("lightswitch: error: ") &&
           ended.err.find('\n') == ended.err.size() - 1;
}

}  // namespace lightswitch::test
