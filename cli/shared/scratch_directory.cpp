#include "cli/shared/scratch_directory.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "service/signals.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};
// The number of times that the directory is emptied: a thread that is still writing may create new
// files meanwhile.
constexpr int most_rounds = 5;

// The path of the directory. It is set before the handlers are installed.
std::array<char, 4096> place{};
std::array<struct sigaction, ending_signals.size()> before{};

// Empties a directory. A signal handler calls this, so it must not allocate memory, as opendir()
// may.
void empty_directory(int directory) {
    alignas(dirent64) std::array<char, 4096> entries{};
    for (;;) {
        const ssize_t got = ::getdents64(directory, entries.data(), entries.size());
        if (got <= 0) return;
        for (ssize_t at = 0; at < got;) {
            const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
            const bool is_own =
                std::strcmp(entry->d_name, ".") == 0 || std::strcmp(entry->d_name, "..") == 0;
            if (!is_own && ::unlinkat(directory, entry->d_name, 0) != 0) {
                ::unlinkat(directory, entry->d_name, AT_REMOVEDIR);
            }
            at += entry->d_reclen;
        }
    }
}

void remove_and_end(int number) {
    for (int round = 0; round < most_rounds; ++round) {
        const int directory = ::open(place.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (directory < 0) break;
        empty_directory(directory);
        ::close(directory);
        if (::rmdir(place.data()) == 0) break;
    }
    ::raise(number);  // SA_RESETHAND has restored the default action
}

void watch_signals() {
    for (std::size_t i = 0; i < ending_signals.size(); ++i) {
        ::sigaction(ending_signals[i], nullptr, &before[i]);
        if (before[i].sa_handler != SIG_DFL) continue;
        struct sigaction action {};
        action.sa_handler = remove_and_end;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        ::sigaction(ending_signals[i], &action, nullptr);
    }
}

void leave_signals() {
    for (std::size_t i = 0; i < ending_signals.size(); ++i) {
        if (before[i].sa_handler == SIG_DFL) ::sigaction(ending_signals[i], &before[i], nullptr);
    }
}

}  // namespace

ScratchDirectory::ScratchDirectory(fs::path path) : path_(std::move(path)) {
    path_.native().copy(place.data(), place.size() - 1);
    watch_signals();
}

ScratchDirectory::ScratchDirectory(ScratchDirectory&& other) noexcept
    : path_(std::exchange(other.path_, fs::path{})) {}

ScratchDirectory::~ScratchDirectory() {
    if (path_.empty()) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    leave_signals();
}

Result<ScratchDirectory> ScratchDirectory::make() {
    std::error_code error;
    const fs::path base = fs::temp_directory_path(error);
    if (error) return fail(ErrorCode::io, "{}: {}", base.native(), error.message());
    std::string name = (base / "stormcellar-XXXXXX").native();
    if (name.size() >= place.size()) {
        return fail(ErrorCode::io, "{}: the name is too long for a temporary directory", name);
    }
    place.fill('\0');
    // Block signals, so that a signal finds the directory both made and watched, or neither.
    const BlockedSignals blocked(ending_signals);
    if (::mkdtemp(name.data()) == nullptr) {
        return fail(ErrorCode::io, "{}: {}", name, std::system_category().message(errno));
    }
    return ScratchDirectory(fs::path{name});
}

}  // namespace stormcellar::cli
