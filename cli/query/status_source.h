// cli/query/status_source.h -- where `stormcellar status` has it from: the running daemon, else its
// file.
//
// A daemon answers on its Unix socket (GET /status.json); where none does, state/status.json says
// what the last one said. Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// At most one of the three is named; none: a service in its usual places.
struct StatusOptions {
    std::string socket, state, config;
    bool json = false;
};

struct StatusPlaces {
    std::vector<std::filesystem::path> sockets;  // tried in this order
    std::filesystem::path file;                  // empty: none
    std::filesystem::path loops;                 // of a process that keeps loops alone; empty: none
};
// bad_argument or what reading the configuration gives.
[[nodiscard]] Result<StatusPlaces> places_of(const StatusOptions& options);

struct StatusAnswer {
    nlohmann::json document;     // an object
    std::filesystem::path from;  // the socket or the file
    std::string silent;          // why no daemon answered; empty: one did
};
// not_found when neither answers: the message says why, place by place.
[[nodiscard]] Result<StatusAnswer> find_status(const StatusPlaces& places);

// Where the daemon keeps no loops itself and another process does or did, its loops as "loops",
// none of them running when it is gone, with those besides that the daemon's configuration names;
// and as "loops_service" what it says of itself ("state","pid","version","started","updated") and
// "alive", whether that process is there.
void add_loops(nlohmann::json& document, const std::filesystem::path& loops);

// "; members of the group GROUP may ask: sudo usermod -aG GROUP USER, then log in again": what to
// do where a socket may not be opened. Empty where its group is not known.
[[nodiscard]] std::string how_to_be_let_in(const std::filesystem::path& socket);

// The document of whoever listens at the path: io with the system's reason, or corrupt when it is
// no status. Waits 5 s at most and reads 16 MiB at most.
[[nodiscard]] Result<nlohmann::json> ask_socket(const std::filesystem::path& path);

}  // namespace stormcellar::cli
