#include "daemon/watch/unreadable.h"

#include <algorithm>
#include <array>

namespace stormcellar::daemon {

void Unreadable::add(const std::filesystem::path& directory, const std::string& reason) {
    if (named.contains(directory.native())) return;
    if (named.size() < most_named) {
        named.emplace(directory.native(), reason);
    } else {
        ++further;
    }
}

bool is_below_home(const std::filesystem::path& path) {
    static const std::array<std::filesystem::path, 3> hidden{"/home", "/root", "/run/user"};
    return std::ranges::any_of(hidden, [&](const std::filesystem::path& home) {
        return std::mismatch(home.begin(), home.end(), path.begin(), path.end()).first ==
               home.end();
    });
}

std::string remedy_for(const std::filesystem::path& drop, ErrorCode code) {
    if (is_below_home(drop) && (code == ErrorCode::permission || code == ErrorCode::not_found))
        return "; the unit hides /home from the service (ProtectHome=) unless ldm-in-home.conf is "
               "installed";
    return remedy_below(code);
}

std::string remedy_below(ErrorCode code) {
    if (code != ErrorCode::permission) return {};
    return "; the service needs a group that may read it (ldm-group.conf)";
}

}  // namespace stormcellar::daemon
