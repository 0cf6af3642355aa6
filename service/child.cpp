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

// A pipe. A started program inherits neither end, unless spawn() passes that end on.
struct Pipe {
    Pipe() {
        std::array<int, 2> ends{-1, -1};
        (void)!::pipe2(ends.data(), O_CLOEXEC);
        reader = Descriptor(ends[0]);
        writer = Descriptor(ends[1]);
    }
    Descriptor reader, writer;
};

// Returns a reader of the pipe that never blocks.
LineReader lines_of(Pipe& pipe) {
    ::fcntl(pipe.reader.number(), F_SETFL, O_NONBLOCK);
    return LineReader(std::move(pipe.reader));
}

}  // namespace

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
    for (int i = 0; i < 16 && descriptor_.is_open(); ++i) {
        const ssize_t got = ::read(descriptor_.number(), buffer.data(), buffer.size());
        if (got > 0) {
            take({buffer.data(), static_cast<std::size_t>(got)}, lines);
        } else if (got < 0 && errno == EINTR) {
            continue;
        } else if (got < 0 && errno == EAGAIN) {
            break;
        } else {
            descriptor_ = {};
            if (!line_.empty()) lines.push_back(std::exchange(line_, {}));
        }
    }
    return lines;
}

Result<Child> Child::start(const fs::path& program, const std::vector<std::string>& arguments) {
    Pipe out;
    Pipe err;
    if (!out.reader.is_open() || !err.reader.is_open())
        return system_failure(program.native(), errno);
    const Result<pid_t> started =
        spawn(program, arguments, {.out = out.writer.number(), .err = err.writer.number()});
    if (!started) return pass_on(started);
    const pid_t id = *started;
    // If permission for these calls is missing, the program runs without their effect.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(id), lower_priority);
    std::ofstream(fmt::format("/proc/{}/oom_score_adj", id)) << first_to_go;
    // Call pidfd_open through syscall(), because its declaration in glibc 2.36 lacks extern "C".
    // Started programs do not inherit the descriptor.
    Child child(id, Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, id, 0))));
    if (!child.descriptor_.is_open()) return system_failure(program.native(), errno);
    child.out = lines_of(out);
    child.err = lines_of(err);
    return child;
}

Child::Child(Child&& other) noexcept
    : out(std::move(other.out)),
      err(std::move(other.err)),
      id_(std::exchange(other.id_, 0)),
      descriptor_(std::move(other.descriptor_)),
      ended_(std::move(other.ended_)) {}

Child& Child::operator=(Child&& other) noexcept {
    kill();
    out = std::move(other.out);
    err = std::move(other.err);
    id_ = std::exchange(other.id_, 0);
    descriptor_ = std::move(other.descriptor_);
    ended_ = std::move(other.ended_);
    return *this;
}

Child::~Child() {
    kill();
}

void Child::kill() {
    if (id_ == 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
    id_ = 0;
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
