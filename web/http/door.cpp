#include "web/http/door.h"

#include <algorithm>

namespace stormcellar::web {

void Doors::add(std::string prefix, std::shared_ptr<Door> door) {
    while (!prefix.empty() && prefix.back() == '/')
        prefix.pop_back();
    doors_.emplace_back(std::move(prefix), std::move(door));
    std::stable_sort(doors_.begin(), doors_.end(),
                     [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
}

std::shared_ptr<Door> Doors::find(std::string_view path) const {
    for (const auto& [prefix, door] : doors_) {
        if (path.starts_with(prefix) &&
            (path.size() == prefix.size() || path[prefix.size()] == '/'))
            return door;
    }
    return nullptr;
}

std::vector<std::string> Doors::prefixes() const {
    std::vector<std::string> prefixes;
    for (const auto& [prefix, door] : doors_)
        prefixes.push_back(prefix.empty() ? "/" : prefix);
    return prefixes;
}

std::vector<std::shared_ptr<WorkQueue>> Doors::workers() const {
    std::vector<std::shared_ptr<WorkQueue>> all;
    for (const auto& [prefix, door] : doors_) {
        for (const auto& own : {door->workers(), door->long_workers()})
            if (own != nullptr && std::find(all.begin(), all.end(), own) == all.end())
                all.push_back(own);
    }
    return all;
}

}  // namespace stormcellar::web
