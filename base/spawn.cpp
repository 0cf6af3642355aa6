#include "base/spawn.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include "base/system_error.h"

extern char** environ;

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

bool is_program(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

// The descriptors of the new program.
class FileActions {
  public:
    explicit FileActions(const SpawnOptions& options) {
        ::posix_spawn_file_actions_init(&actions_);
        connect(options.in, STDIN_FILENO, O_RDONLY);
        connect(options.out, STDOUT_FILENO, O_WRONLY);
        connect(options.err, STDERR_FILENO, O_WRONLY);
        ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
    [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    void connect(int from, int to, int flags) {
        if (from < 0) {
            ::posix_spawn_file_actions_addopen(&actions_, to, "/dev/null", flags, 0);
        } else {
            ::posix_spawn_file_actions_adddup2(&actions_, from, to);
        }
    }
    posix_spawn_file_actions_t actions_{};
};

// The signals and the group of the new program.
class Attributes {
  public:
    explicit Attributes(bool is_apart) {
        ::posix_spawnattr_init(&attributes_);
        if (!is_apart) return;
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setsigdefault(&attributes_, &all);
        ::posix_spawnattr_setpgroup(&attributes_, 0);
        ::posix_spawnattr_setflags(
            &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    Attributes(const Attributes&) = delete;
    Attributes& operator=(const Attributes&) = delete;
    ~Attributes() { ::posix_spawnattr_destroy(&attributes_); }
    [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

  private:
    posix_spawnattr_t attributes_{};
};

}  // namespace

Result<pid_t> spawn(const fs::path& program, const std::vector<std::string>& arguments,
                    const SpawnOptions& options) {
    std::string name = program.native();
    std::vector<std::string> copies = arguments;
    std::vector<char*> words{name.data()};
    for (std::string& copy : copies)
        words.push_back(copy.data());
    words.push_back(nullptr);
    const FileActions files(options);
    const Attributes attributes(options.is_apart);
    pid_t child = 0;
    const int failure =
        ::posix_spawn(&child, name.c_str(), files.get(), attributes.get(), words.data(), environ);
    if (failure != 0) return system_failure(name, failure);
    return child;
}

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

}  // namespace stormcellar
