#include "batch/leftovers.h"

#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <signal.h>

#include "base/host_name.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;

// Returns the process that the file's name contains, or none if the name contains another host.
std::optional<pid_t> process_of(std::string_view name) {
    const std::string prefix = fmt::format("{}{}-", temporary_prefix, host_name());
    if (!name.starts_with(prefix)) return std::nullopt;
    name.remove_prefix(prefix.size());
    pid_t process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    if (error != std::errc{} || process <= 0) return std::nullopt;
    return process;
}

bool has_ended(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

std::vector<fs::path> directories_of(const Recipe& recipe, const Task& task) {
    const auto* const hour = std::get_if<FrameHour>(&task.work);
    const auto* const day = std::get_if<StationDay>(&task.work);
    if (day == nullptr && hour == nullptr) return {};
    const std::string domain =
        day != nullptr ? recipe.domain_of(day->station) : recipe.domain->name;
    const UtcTime from = day != nullptr ? UtcTime{day->day} - std::chrono::days{1} : hour->from;
    const UtcTime to = day != nullptr ? UtcTime{day->day} + std::chrono::days{1} : hour->to;
    std::vector<fs::path> directories;
    for (const level2::Moment moment : recipe.moments) {
        for (UtcTime at = from; at <= to; at += std::chrono::days{1}) {
            directories.push_back(recipe.cache /
                                  cache::relative_path({domain, moment, at}).parent_path());
        }
    }
    return directories;
}

}  // namespace

void remove_own_leftovers(const Recipe& recipe, const Task& task) {
    for (const fs::path& directory : directories_of(recipe, task)) {
        std::error_code error;
        std::vector<fs::path> found;
        for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
             entry.increment(error)) {
            const auto process = process_of(entry->path().filename().native());
            if (process && has_ended(*process)) found.push_back(entry->path());
        }
        for (const fs::path& path : found)
            (void)real_file_system().remove(path);
    }
}

std::size_t remove_all_leftovers(const Plan& plan) {
    std::size_t removed = 0;
    for (const fs::path& root :
         {plan.recipe().cache, plan.directory() / "tasks", plan.directory() / "statistics"}) {
        std::error_code error;
        std::vector<fs::path> found;
        for (fs::recursive_directory_iterator entry(root, error), end; !error && entry != end;
             entry.increment(error)) {
            if (entry->path().filename().native().starts_with(temporary_prefix))
                found.push_back(entry->path());
        }
        for (const fs::path& path : found)
            removed += real_file_system().remove(path) ? 1 : 0;
    }
    return removed;
}

}  // namespace stormcellar::batch
