#include "cache/store.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include <sys/stat.h>

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".scg";

ErrorCode code_of(const std::error_code& error) {
    if (error == std::errc::no_such_file_or_directory) return ErrorCode::not_found;
    if (error == std::errc::permission_denied || error == std::errc::read_only_file_system) {
        return ErrorCode::permission;
    }
    if (error == std::errc::no_space_on_device) return ErrorCode::no_space;
    if (error == std::errc::not_a_directory) return ErrorCode::not_a_file;
    return ErrorCode::io;
}

tl::unexpected<Error> failure(const fs::path& path, const std::error_code& error) {
    return fail(code_of(error), "{}: {}", path.native(), error.message());
}

// The names in a directory, sorted. Links are not followed; what vanishes meanwhile is left out,
// and a directory that is not there holds nothing.
Result<std::vector<std::string>> names_in(const fs::path& directory, fs::file_type type) {
    std::error_code error;
    fs::directory_iterator entry(directory, error);
    if (error == std::errc::no_such_file_or_directory) return std::vector<std::string>{};
    if (error) return failure(directory, error);
    std::vector<std::string> names;
    while (entry != fs::directory_iterator{}) {
        std::error_code ignored;
        if (entry->symlink_status(ignored).type() == type) {
            names.push_back(entry->path().filename().native());
        }
        entry.increment(error);
        if (error) return failure(directory, error);
    }
    std::sort(names.begin(), names.end());
    return names;
}

bool is_day_name(std::string_view name) {
    return name.size() == 8 &&
           std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string day_name(UtcTime time) {
    return format_compact(time).substr(0, 8);
}

std::string stem_prefix(std::string_view domain, level2::Moment moment) {
    return fmt::format("{}_{}_", domain, level2::moment_name(moment));
}

std::string file_name(std::string_view domain, level2::Moment moment, UtcTime time) {
    const auto milliseconds = time - std::chrono::floor<std::chrono::seconds>(time);
    return fmt::format("{}{}_{:03}{}", stem_prefix(domain, moment), format_compact(time),
                       milliseconds.count(), extension);
}

bool is_possible(UtcTime time) {
    using namespace std::chrono;
    return UtcTime{} <= time && time < UtcTime{sys_days{year{10000} / 1 / 1}};
}

// The time in a name that is exactly of the form that file_name makes; none for every other.
std::optional<UtcTime> time_in_name(std::string_view domain, level2::Moment moment,
                                    std::string_view name) {
    const std::string prefix = stem_prefix(domain, moment);
    constexpr std::size_t seconds_length = 15;  // YYYYMMDD_HHMMSS
    if (!name.starts_with(prefix) ||
        name.size() != prefix.size() + seconds_length + 4 + extension.size()) {
        return std::nullopt;
    }
    const Result<UtcTime> seconds = parse_compact(name.substr(prefix.size(), seconds_length));
    if (!seconds) return std::nullopt;
    int milliseconds = 0;
    for (const char c : name.substr(prefix.size() + seconds_length + 1, 3)) {
        if (c < '0' || c > '9') return std::nullopt;
        milliseconds = milliseconds * 10 + (c - '0');
    }
    const UtcTime time = *seconds + std::chrono::milliseconds{milliseconds};
    if (!is_possible(time) || file_name(domain, moment, time) != name) return std::nullopt;
    return time;
}

// Removes what a killed writer left in one day's directory: our prefix, regular files only.
Status sweep_day(FileSystem& file_system, const fs::path& day) {
    const auto names = names_in(day, fs::file_type::regular);
    if (!names) return pass_on(names);
    for (const auto& name : *names) {
        if (!name.starts_with(temporary_prefix)) continue;
        Status removed = file_system.remove(day / name);
        if (!removed && removed.error().code != ErrorCode::not_found) return removed;
    }
    return {};
}

Result<std::vector<std::string>> days_in(const fs::path& directory) {
    auto names = names_in(directory, fs::file_type::directory);
    if (names) std::erase_if(*names, [](const auto& name) { return !is_day_name(name); });
    return names;
}

Result<std::vector<std::string>> moments_in(const fs::path& directory) {
    auto names = names_in(directory, fs::file_type::directory);
    if (names) {
        std::erase_if(*names, [](const auto& name) { return !level2::moment_from_name(name); });
    }
    return names;
}

}  // namespace

struct Store::DurableDirectories {
    std::mutex mutex;
    std::set<fs::path> paths;  // guarded by mutex
};

bool is_domain_name(std::string_view name) {
    const auto is_alphanumeric = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    return !name.empty() && name.size() <= 64 && is_alphanumeric(name.front()) &&
           std::all_of(name.begin(), name.end(),
                       [&](char c) { return is_alphanumeric(c) || c == '_' || c == '-'; });
}

Store::Store(FileSystem* file_system, fs::path directory)
    : file_system_(file_system),
      directory_(std::move(directory)),
      durable_(std::make_shared<DurableDirectories>()) {}

Result<Store> Store::open_for_reading(fs::path directory) {
    std::error_code error;
    const fs::file_status status = fs::status(directory, error);
    if (status.type() == fs::file_type::not_found) {
        return fail(ErrorCode::not_found, "{}: there is no cache here", directory.native());
    }
    if (error) return failure(directory, error);
    if (status.type() != fs::file_type::directory) {
        return fail(ErrorCode::not_a_file, "{}: is not a directory", directory.native());
    }
    return Store(nullptr, std::move(directory));
}

Result<Store> Store::open_for_writing(FileSystem& file_system, fs::path directory,
                                      bool sweep_temporary) {
    std::error_code error;
    const bool created = fs::create_directories(directory, error);
    if (error) return failure(directory, error);
    if (created) {
        const fs::path parent = fs::absolute(directory).lexically_normal().parent_path();
        if (Status synced = file_system.sync_directory(parent); !synced) return pass_on(synced);
    }
    Store store(&file_system, std::move(directory));
    if (!sweep_temporary) return store;

    const auto domains = store.domains();
    if (!domains) return pass_on(domains);
    for (const auto& domain : *domains) {
        const auto moments = moments_in(store.directory_ / domain);
        if (!moments) return pass_on(moments);
        for (const auto& moment : *moments) {
            const fs::path parent = store.directory_ / domain / moment;
            const auto days = days_in(parent);
            if (!days) return pass_on(days);
            for (const auto& day : *days) {
                if (Status swept = sweep_day(file_system, parent / day); !swept) {
                    return pass_on(swept);
                }
            }
        }
    }
    return store;
}

// A directory's name is durable once its parent was synced. The first use of a directory that
// stands already syncs too: its maker may have been killed before it could.
Status Store::make_directory(const fs::path& directory) const {
    std::error_code error;
    const bool created = fs::create_directory(directory, error);
    if (error) return failure(directory, error);
    if (!created) {
        const std::scoped_lock lock(durable_->mutex);
        if (durable_->paths.contains(directory)) return {};
    }
    if (Status synced = file_system_->sync_directory(directory.parent_path()); !synced) {
        return synced;
    }
    const std::scoped_lock lock(durable_->mutex);
    durable_->paths.insert(directory);
    return {};
}

Result<fs::path> Store::path_of(const std::string& domain, level2::Moment moment,
                                UtcTime time) const {
    if (!is_domain_name(domain)) {
        return fail(ErrorCode::bad_argument,
                    "domain '{}': a name is up to 64 letters, digits, _ and -, and begins with a "
                    "letter or digit",
                    domain);
    }
    if (!is_possible(time)) {
        return fail(ErrorCode::bad_argument,
                    "a grid of {}: its time is beyond the years 1970 to 9999", domain);
    }
    return directory_ / domain / std::string(level2::moment_name(moment)) / day_name(time) /
           file_name(domain, moment, time);
}

Result<fs::path> Store::commit(const std::string& domain, const GridDescription& description,
                               const grid::BrickView& view) const {
    if (file_system_ == nullptr) {
        return fail(ErrorCode::bad_argument, "{}: the cache was opened for reading only",
                    directory_.native());
    }
    Result<fs::path> path = path_of(domain, description.moment, description.time);
    if (!path) return path;
    const fs::path day = path->parent_path();
    const fs::path& moment = day.parent_path();
    for (const fs::path& directory : {directory_, moment.parent_path(), moment, day}) {
        if (Status made = make_directory(directory); !made) return pass_on(made);
    }
    const auto written = write_grid_file(*file_system_, *path, description, view);
    if (!written) return pass_on(written);
    return path;
}

Result<std::vector<std::string>> Store::domains() const {
    auto names = names_in(directory_, fs::file_type::directory);
    if (!names) return names;
    std::vector<std::string> domains;
    for (auto& name : *names) {
        if (!is_domain_name(name)) continue;
        const auto moments = moments_in(directory_ / name);
        if (!moments) return pass_on(moments);
        if (!moments->empty()) domains.push_back(std::move(name));
    }
    return domains;
}

Result<std::vector<StoreEntry>> Store::list(const std::string& domain, level2::Moment moment,
                                            std::optional<UtcTime> from,
                                            std::optional<UtcTime> to) const {
    std::vector<StoreEntry> entries;
    if (!is_domain_name(domain)) return entries;
    const fs::path parent = directory_ / domain / std::string(level2::moment_name(moment));
    const auto days = days_in(parent);
    if (!days) return pass_on(days);
    // Days are compared by their names, so a query reads the directories that it needs. Bounds
    // beyond the times of any grid are brought to them first.
    const UtcTime last_time = UtcTime{std::chrono::sys_days{std::chrono::year{10000} / 1 / 1}} -
                              std::chrono::milliseconds{1};
    const UtcTime lower = std::clamp(from.value_or(UtcTime{}), UtcTime{}, last_time);
    const UtcTime upper = std::clamp(to.value_or(last_time), UtcTime{}, last_time);
    const std::string first_day = day_name(lower);
    const std::string last_day = day_name(upper);
    for (const auto& day : *days) {
        if (day < first_day || day > last_day) continue;
        const auto names = names_in(parent / day, fs::file_type::regular);
        if (!names) return pass_on(names);
        for (const auto& name : *names) {
            const auto time = time_in_name(domain, moment, name);
            if (!time || day_name(*time) != day || (from && *time < *from) || (to && *time > *to)) {
                continue;
            }
            struct stat facts {};
            fs::path path = parent / day / name;
            if (::lstat(path.c_str(), &facts) != 0) continue;  // evicted meanwhile
            entries.push_back({domain, moment, *time, std::move(path),
                               static_cast<std::uint64_t>(facts.st_blocks) * 512});
        }
    }
    return entries;
}

}  // namespace stormcellar::cache
