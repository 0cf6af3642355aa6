#include "daemon/loops/loop_check.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <system_error>

#include <poll.h>
#include <unistd.h>

#include "base/printable.h"
#include "base/spawn.h"
#include "service/child.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::daemon {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds longest_check{60};

std::string without_speaker(const std::string& line) {
    constexpr std::string_view speaker = "stormcellar: ";
    return printable(line.starts_with(speaker) ? line.substr(speaker.size()) : line);
}

// Stores the first line that the program prints and that is not a note.
void take_complaint(Child& child, std::string& complaint) {
    for (const std::string& line : child.err.read()) {
        const std::string text = without_speaker(line);
        if (complaint.empty() && !text.starts_with("note: ")) complaint = text;
    }
    (void)child.out.read();
}

Status check_loop(const LoopConfig& loop, const std::filesystem::path& cache,
                  const std::filesystem::path& program) {
    auto arguments = arguments_of(loop, cache, ::getpid());
    arguments.emplace_back("--check");
    Result<Child> child = Child::start(program, arguments);
    if (!child) return pass_on(child);
    std::string complaint;
    const auto until = SteadyClock::now() + longest_check;
    while (SteadyClock::now() < until) {
        const std::string how = child->ended();  // call first: once the program has ended, all of
                                                 // its output is available
        take_complaint(*child, complaint);
        if (how == "status 0") return {};
        if (!how.empty()) {
            return fail(ErrorCode::bad_argument, "[[loop]] {}: {}", loop.name,
                        complaint.empty() ? "stormcellar loop ended with " + how : complaint);
        }
        std::array<pollfd, 3> sources{{{child->descriptor(), POLLIN, 0},
                                       {child->out.descriptor(), POLLIN, 0},
                                       {child->err.descriptor(), POLLIN, 0}}};
        ::poll(sources.data(), sources.size(), 1000);
    }
    return fail(ErrorCode::io, "[[loop]] {}: stormcellar loop does not answer", loop.name);
}

bool is_known(const std::string& name, const std::vector<pipeline::Domain>& domains) {
    // For the part "north.KTLX", check its domain "north".
    const std::string_view whole = cache::group_of(name);
    return find_station(name) || std::any_of(domains.begin(), domains.end(),
                                             [&](const auto& one) { return one.name == whole; });
}

}  // namespace

std::vector<std::string> doubts_about(const std::vector<LoopConfig>& loops,
                                      const std::vector<pipeline::Domain>& domains) {
    std::vector<std::string> doubts;
    const auto doubt = [&](const LoopConfig& loop, const std::string& what) {
        doubts.push_back(fmt::format("[[loop]] {}: {}", printable(loop.name), printable(what)));
    };
    for (const LoopConfig& loop : loops) {
        if (!loop.domain.empty() && !is_known(loop.domain, domains)) {
            doubt(loop, fmt::format("domain '{}' is neither a known station nor a [[domain]]; the "
                                    "loop waits for grids of that name",
                                    loop.domain));
        }
        for (const std::string& output : loop.outputs) {
            const std::filesystem::path path(output);
            const auto directory = (path.has_filename() ? path : path.parent_path()).parent_path();
            std::error_code error;
            if (std::filesystem::is_directory(directory, error)) continue;
            doubt(loop,
                  fmt::format("{}: there is no directory {} (yet), so the loop cannot be written",
                              output, directory.native()));
        }
    }
    return doubts;
}

Status check_loops(const std::vector<LoopConfig>& loops, const std::filesystem::path& cache,
                   std::filesystem::path program) {
    if (loops.empty()) return {};
    if (program.empty()) program = find_program("stormcellar");
    if (program.empty()) {
        return fail(ErrorCode::not_found,
                    "[[loop]] {}: there is no program stormcellar beside stormcellard or on PATH",
                    loops.front().name);
    }
    for (const LoopConfig& loop : loops) {
        if (auto fine = check_loop(loop, cache, program); !fine) return fine;
    }
    return {};
}

}  // namespace stormcellar::daemon
