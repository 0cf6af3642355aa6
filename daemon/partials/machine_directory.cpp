#include "daemon/partials/machine_directory.h"

#include <utility>

namespace stormcellar::daemon {

namespace fs = std::filesystem;

MachineDirectory::MachineDirectory(fs::path directory, std::unique_ptr<EventSource> events)
    : directory_(std::move(directory)),
      events_(std::move(events)),
      watcher_(directory_, *events_, *this) {}

Status MachineDirectory::scan() {
    return watcher_.scan();
}

std::optional<cache::GridName> MachineDirectory::name_of(const fs::path& path) const {
    const fs::path relative = path.lexically_relative(directory_);
    std::vector<std::string> parts;
    for (const fs::path& part : relative)
        parts.push_back(part.native());
    if (parts.size() != 4 || !cache::is_domain_name(parts[0]) || !cache::is_part(parts[0]))
        return std::nullopt;
    const auto moment = level2::moment_from_name(parts[1]);
    if (!moment) return std::nullopt;
    const auto time = cache::time_in_file_name(parts[0], *moment, parts[3]);
    if (!time) return std::nullopt;
    cache::GridName name{parts[0], *moment, *time};
    if (cache::relative_path(name) != relative) return std::nullopt;
    return name;
}

void MachineDirectory::look(const fs::path& path, const FileStamp& stamp) {
    const auto name = name_of(path);
    if (!name) return;
    const auto [seen, is_new] = seen_.try_emplace(*name, Seen{stamp});
    if (!is_new && seen->second.stamp == stamp) return;
    seen->second = {stamp};
    news_.insert(*name);
}

void MachineDirectory::file_closed(const fs::path& path, const FileStamp& stamp) {
    look(path, stamp);
}

// Handles a hard link, or a file that is still being written. If the file is incomplete,
// PartialsKeeper checks it again later.
void MachineDirectory::file_created(const fs::path& path, const FileStamp& stamp) {
    if (stamp.size_bytes > 0) look(path, stamp);
}

void MachineDirectory::file_found(const fs::path& path, const FileStamp& stamp) {
    look(path, stamp);
}

void MachineDirectory::file_gone(const fs::path& path) {
    const auto name = name_of(path);
    if (!name) return;
    seen_.erase(*name);
    news_.erase(*name);
}

std::optional<cache::GridName> MachineDirectory::take_news() {
    if (news_.empty()) return std::nullopt;
    return news_.extract(news_.begin()).value();
}

void MachineDirectory::refuse(const cache::GridName& name) {
    const auto seen = seen_.find(name);
    if (seen != seen_.end()) seen->second.is_refused = true;
}

bool MachineDirectory::has(const cache::GridName& name) const {
    const auto seen = seen_.find(name);
    return seen != seen_.end() && !seen->second.is_refused;
}

std::vector<cache::GridName> MachineDirectory::known() const {
    std::vector<cache::GridName> names;
    for (const auto& [name, seen] : seen_)
        if (!news_.contains(name) && !seen.is_refused) names.push_back(name);
    return names;
}

}  // namespace stormcellar::daemon
