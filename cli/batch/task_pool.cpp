#include "cli/batch/task_pool.h"

#include <cerrno>
#include <deque>
#include <map>
#include <string>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/spawn.h"
#include "cli/batch/batch.h"

namespace stormcellar::cli {
namespace {

constexpr int most_tries = 3;

struct Turn {
    std::size_t task = 0;
    int tries = 1;
};

// Starts a task as a child process that writes to our output. Ctrl-C reaches both this process and
// the child.
Result<pid_t> start(const PoolJob& job, std::size_t task) {
    return spawn(job.program,
                 {"batch", job.command, "--plan", job.plan, "--task", std::to_string(task),
                  "--threads", std::to_string(job.threads)},
                 {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO, false});
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
        if (running.empty()) break;  // the stop flag is set and all tasks have ended
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
