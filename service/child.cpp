#include "service/child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

constexpr int lower_priority = 10;
constexpr int first_to_go = 500;

bool is_program(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

tl::unexpected<Error> failed(int number, const std::string& what) {
    const ErrorCode code = number == ENOENT                      ? ErrorCode::not_found
                           : number == EACCES || number == EPERM ? ErrorCode::permission
                                                                 : ErrorCode::io;
    return fail(code, "{}: {}", what, std::generic_category().message(number));
}

// The programs that are started get neither end.
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
    // Hands over the reading end, which never blocks.
    int take_reader() {
        ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
        return std::exchange(ends[0], -1);
    }
};

int spawn(const fs::path& program, std::vector<std::string> arguments, const Pipe& out,
          const Pipe& err, pid_t& child) {
    std::string name = program.native();
    std::vector<char*> pointers{name.data()};
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&files, out.ends[1], 1);
    ::posix_spawn_file_actions_adddup2(&files, err.ends[1], 2);
    ::posix_spawn_file_actions_addclosefrom_np(&files, 3);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setsigdefault(&attributes, &all);
    ::posix_spawnattr_setpgroup(&attributes, 0);
    ::posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    const int failure =
        ::posix_spawn(&child, name.c_str(), &files, &attributes, pointers.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&files);
    return failure;
}

}  // namespace

fs::path find_program(std::string_view name) {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    if (!error && is_program(self.parent_path() / name)) return self.parent_path() / name;
    const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): never set here
    std::string_view rest = path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path;
    while (!rest.empty()) {
        const std::string_view directory = rest.substr(0, rest.find(':'));
        rest.remove_prefix(std::min(rest.size(), directory.size() + 1));
        if (!directory.empty() && is_program(fs::path(directory) / name)) {
            return fs::path(directory) / name;
        }
    }
    return {};
}

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
    if (out.ends[0] < 0 || err.ends[0] < 0) return failed(errno, program.native());
    pid_t id = 0;
    if (const int failure = spawn(program, arguments, out, err, id); failure != 0) {
        return failed(failure, program.native());
    }
    // If the service may not change these, it goes on without.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(id), lower_priority);
    std::ofstream(fmt::format("/proc/{}/oom_score_adj", id)) << first_to_go;
    // The C library's own declaration lacks its extern "C" (glibc 2.36). The descriptor is closed
    // in programs that are started.
    Child child(id, static_cast<int>(::syscall(SYS_pidfd_open, id, 0)));
    if (child.descriptor_ < 0) return failed(errno, program.native());
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
