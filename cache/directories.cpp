#include "cache/directories.h"

#include <algorithm>
#include <string_view>

#include <sys/stat.h>

#include "base/system_error.h"
#include "cache/pins.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

// Returns true if the entry has the type and is not a link. The entry usually knows its type, so
// that no system call is needed.
bool is_of_type(const fs::directory_entry& entry, fs::file_type type) {
    std::error_code ignored;
    if (entry.is_symlink(ignored)) return false;
    return type == fs::file_type::directory ? entry.is_directory(ignored)
                                            : entry.is_regular_file(ignored);
}

Result<std::vector<std::string>> names_in(const fs::path& directory, fs::file_type type) {
    std::error_code error;
    fs::directory_iterator entry(directory, error);
    if (error == std::errc::no_such_file_or_directory) return std::vector<std::string>{};
    if (error) return directory_failure(directory, error);
    std::vector<std::string> names;
    while (entry != fs::directory_iterator{}) {
        if (is_of_type(*entry, type)) names.push_back(entry->path().filename().native());
        entry.increment(error);
        if (error) return directory_failure(directory, error);
    }
    std::sort(names.begin(), names.end());
    return names;
}

UtcTime time_of(const timespec& time) {
    using namespace std::chrono;
    return UtcTime{seconds{time.tv_sec} + duration_cast<milliseconds>(nanoseconds{time.tv_nsec})};
}

}  // namespace

tl::unexpected<Error> directory_failure(const fs::path& path, const std::error_code& error) {
    const ErrorCode code =
        error == std::errc::not_a_directory ? ErrorCode::not_a_file : error_code_of(error.value());
    return fail(code, "{}: {}", path.native(), error.message());
}

Result<std::vector<level2::Moment>> moments_in(const fs::path& domain) {
    const auto names = names_in(domain, fs::file_type::directory);
    if (!names) return pass_on(names);
    std::vector<level2::Moment> moments;
    for (const std::string& name : *names) {
        if (const auto moment = level2::moment_from_name(name)) moments.push_back(*moment);
    }
    std::sort(moments.begin(), moments.end());
    return moments;
}

Result<std::vector<std::string>> domains_in(const fs::path& cache) {
    auto names = names_in(cache, fs::file_type::directory);
    if (!names) return names;
    std::vector<std::string> domains;
    for (auto& name : *names) {
        if (!is_domain_name(name)) continue;
        const auto moments = moments_in(cache / name);
        if (!moments) return pass_on(moments);
        if (!moments->empty()) domains.push_back(std::move(name));
    }
    return domains;
}

Result<std::vector<std::string>> days_in(const fs::path& moment) {
    auto names = names_in(moment, fs::file_type::directory);
    if (names) std::erase_if(*names, [](const auto& name) { return !is_day_name(name); });
    return names;
}

fs::path relative_path(const Day& day) {
    return fs::path(day.domain) / std::string(level2::moment_name(day.moment)) / day.day;
}

Result<std::vector<Day>> all_days(const fs::path& cache) {
    const auto domains = domains_in(cache);
    if (!domains) return pass_on(domains);
    std::vector<Day> all;
    for (const std::string& domain : *domains) {
        const auto moments = moments_in(cache / domain);
        if (!moments) return pass_on(moments);
        for (const level2::Moment moment : *moments) {
            auto days = days_in(cache / domain / std::string(level2::moment_name(moment)));
            if (!days) return pass_on(days);
            for (std::string& day : *days)
                all.push_back({domain, moment, std::move(day)});
        }
    }
    return all;
}

std::optional<FoundGrid> look_at_grid(const fs::path& path, UtcTime time) {
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode)) return std::nullopt;
    return FoundGrid{time, static_cast<std::uint64_t>(facts.st_blocks) * 512,
                     time_of(facts.st_mtim), is_pinned(path)};
}

Result<DayContents> read_day(const fs::path& cache, const Day& day, UtcTime from, UtcTime to) {
    const fs::path directory = cache / relative_path(day);
    const auto names = names_in(directory, fs::file_type::regular);
    if (!names) return pass_on(names);
    DayContents contents;
    for (const std::string& name : *names) {
        const auto time = time_in_file_name(day.domain, day.moment, name);
        const bool grid = time && day_name(*time) == day.day && *time >= from && *time <= to;
        if (!grid && !name.starts_with(temporary_prefix)) continue;
        struct stat facts {};
        // The grid was evicted since it was listed.
        if (::lstat((directory / name).c_str(), &facts) != 0) continue;
        const std::uint64_t bytes = static_cast<std::uint64_t>(facts.st_blocks) * 512;
        if (grid) {
            const bool pinned =
                std::binary_search(names->begin(), names->end(), name + std::string(pin_extension));
            contents.grids.push_back({*time, bytes, time_of(facts.st_mtim), pinned});
        } else {
            contents.temporaries.push_back({name, bytes});
        }
    }
    return contents;
}

Status sweep_temporaries(FileSystem& file_system, const fs::path& cache) {
    const auto days = all_days(cache);
    if (!days) return pass_on(days);
    for (const Day& day : *days) {
        Status removed = remove_temporaries(file_system, cache / relative_path(day));
        if (!removed) return removed;
    }
    return remove_temporaries(file_system, cache);
}

}  // namespace stormcellar::cache
