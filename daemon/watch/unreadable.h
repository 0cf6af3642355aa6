// daemon/watch/unreadable.h -- directories that the service cannot read, and possible remedies.
//
// Threads   A plain value and a pure function.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Directories below the drop directory that cannot be read, with the reason and the remedy.
struct Unreadable {
    static constexpr std::size_t most_named = 16;

    std::map<std::string, std::string> named;  // reasons of the directories found first, by path
    std::uint64_t further = 0;

    void add(const std::filesystem::path& directory, const std::string& reason);
    [[nodiscard]] std::uint64_t count() const { return named.size() + further; }
    [[nodiscard]] bool operator==(const Unreadable&) const = default;
};

// Return the end of a sentence that says how to make a directory readable to the service; empty if
// no remedy is known. remedy_for() is for the drop directory itself, which the unit of systemd may
// hide (ProtectHome=). remedy_below() is for directories below the drop directory, for which the
// service may lack a group.
[[nodiscard]] std::string remedy_for(const std::filesystem::path& drop, ErrorCode code);
[[nodiscard]] std::string remedy_below(ErrorCode code);

// Returns true if ProtectHome= hides the path.
[[nodiscard]] bool is_below_home(const std::filesystem::path& path);

}  // namespace stormcellar::daemon
