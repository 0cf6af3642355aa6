#include "service/child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/spawn.h"
#include "base/system_error.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

constexpr int lower_priority = 10;
constexpr int first_to_go = 500;

// A pipe. Programs that are started later inherit neither end.
struct Pipe {
    std::array<int, 2> ends{-1, -1};

    Pipe() {
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) ends = {-1, -1};
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        for (const int end : ends) {
            if (end >= 0) ::close(end);
        }
    }
    // Returns the reading end, which never blocks, and gives up ownership.
    int take_reader() {
        ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
        return std::exchange(ends[0], -1);
    }
};

}  // namespace

LineReader::LineReader(LineReader&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), line_(std::move(other.line_)) {}

LineReader& LineReader::operator=(LineReader&& other) noexcept {
    close();
    descriptor_ = std::exchange(other.descriptor_, -1);
    line_ = std::move(other.line_);
    return *this;
}

LineReader::~LineReader() {
    close();
}

void LineReader::close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
}

void LineReader::take(std::string_view bytes, std::vector<std::string>& lines) {
    for (const char c : bytes) {
        if (c == '\n') {
            lines.push_back(std::exchange(line_, {}));
        } else if (line_.size() < longest_line) {
            line_ += c;
        }
    }
}

std::vector<std::string> LineReader::read() {
    std::vector<std::string> lines;
    std::array<char, 4096> buffer{};
    for (int i = 0; i < 16 && descriptor_ >= 0; ++i) {
        const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
        if (got > 0) {
            take({buffer.data(), static_cast<std::size_t>(got)}, lines);
        } else if (got < 0 && errno == EINTR) {
            continue;
        } else if (got < 0 && errno == EAGAIN) {
            break;
        } else {
            close();
            if (!line_.empty()) lines.push_back(std::exchange(line_, {}));
        }
    }
    return lines;
}

Result<Child> Child::start(const fs::path& program, const std::vector<std::string>& arguments) {
    Pipe out;
    Pipe err;
    if (out.ends[0] < 0 || err.ends[0] < 0) return system_failure(program.native(), errno);
    const Result<pid_t> started =
        spawn(program, arguments, {.out = out.ends[1], .err = err.ends[1]});
    if (!started) return pass_on(started);
    const pid_t id = *started;
    // If the service may not change these, the program runs without them.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(id), lower_priority);
    std::ofstream(fmt::format("/proc/{}/oom_score_adj", id)) << first_to_go;
    // The C library's own declaration lacks its extern "C" (glibc 2.36). The descriptor is closed
    // in programs that are started.
    Child child(id, static_cast<int>(::syscall(SYS_pidfd_open, id, 0)));
    if (child.descriptor_ < 0) return system_failure(program.native(), errno);
    child.out = LineReader(out.take_reader());
    child.err = LineReader(err.take_reader());
    return child;
}

Child::Child(Child&& other) noexcept
    : out(std::move(other.out)),
      err(std::move(other.err)),
      id_(std::exchange(other.id_, 0)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      ended_(std::move(other.ended_)) {}

Child& Child::operator=(Child&& other) noexcept {
    release();
    out = std::move(other.out);
    err = std::move(other.err);
    id_ = std::exchange(other.id_, 0);
    descriptor_ = std::exchange(other.descriptor_, -1);
    ended_ = std::move(other.ended_);
    return *this;
}

Child::~Child() {
    release();
}

void Child::release() {
    if (id_ != 0) {
        ::kill(id_, SIGKILL);
        ::waitpid(id_, nullptr, 0);
    }
    if (descriptor_ >= 0) ::close(descriptor_);
    id_ = 0;
    descriptor_ = -1;
}

void Child::signal(int number) const {
    if (id_ != 0) ::kill(id_, number);
}

std::string Child::ended() {
    int status = 0;
    if (id_ != 0 && ::waitpid(id_, &status, WNOHANG) == id_) {
        id_ = 0;
        ended_ = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                     : fmt::format("status {}", WEXITSTATUS(status));
    }
    return ended_;
}

}  // namespace stormcellar
