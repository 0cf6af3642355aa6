#include "cli/batch/task_pool.h"

#include <array>
#include <cerrno>
#include <deque>
#include <map>
#include <string>

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system_error.h"
#include "cli/batch/batch.h"

namespace stormcellar::cli {
namespace {

constexpr int most_tries = 3;

struct Turn {
    std::size_t task = 0;
    int tries = 1;
};

Result<pid_t> start(const PoolJob& job, std::size_t task) {
    const std::array<std::string, 9> words{job.program.native(),
                                           "batch",
                                           job.command,
                                           "--plan",
                                           job.plan,
                                           "--task",
                                           std::to_string(task),
                                           "--threads",
                                           std::to_string(job.threads)};
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int error =
        ::posix_spawn(&child, words[0].c_str(), nullptr, nullptr, arguments.data(), environ);
    if (error != 0) return system_failure(words[0], error);
    return child;
}

}  // namespace

Result<std::vector<std::size_t>> run_pool(const PoolJob& job, const std::vector<std::size_t>& tasks,
                                          const std::atomic<bool>& stop,
                                          const std::function<void(std::size_t done)>& done) {
    std::deque<Turn> left;
    for (const std::size_t task : tasks)
        left.push_back({task});
    std::map<pid_t, Turn> running;
    std::vector<std::size_t> failed;
    std::size_t ended = 0;
    while (!left.empty() || !running.empty()) {
        while (!stop && !left.empty() && running.size() < static_cast<std::size_t>(job.jobs)) {
            const auto child = start(job, left.front().task);
            if (!child) return pass_on(child);
            running[*child] = left.front();
            left.pop_front();
        }
        if (running.empty()) break;  // stopped
        int status = 0;
        const pid_t child = ::wait(&status);
        if (child < 0 && errno == EINTR) {
            for (const auto& [process, turn] : running)
                ::kill(process, SIGTERM);
            continue;
        }
        const auto found = running.find(child);
        if (found == running.end()) continue;
        const Turn turn = found->second;
        running.erase(found);
        const bool again = WIFEXITED(status) && WEXITSTATUS(status) == exit_try_again;
        if (again && !stop && turn.tries < most_tries) {
            left.push_back({turn.task, turn.tries + 1});
            continue;
        }
        if (!WIFEXITED(status) || WEXITSTATUS(status) != exit_done) failed.push_back(turn.task);
        done(++ended);
    }
    return failed;
}

}  // namespace stormcellar::cli
