// cli/query/status_source.h -- gets the status from the running daemon, or else from its file.
//
// A daemon answers on its Unix socket (GET /status.json). If no daemon answers, the file
// state/status.json has the last status that a daemon wrote.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// At most one of these places is set. If no place is set, the service is looked for in its usual
// places.
struct StatusOptions {
    std::string socket, state, config;
    bool json = false;
};

struct StatusPlaces {
    std::vector<std::filesystem::path> sockets;  // tried in this order
    std::filesystem::path file;                  // empty: none
    // Status file of a process that only runs loops; empty: none.
    std::filesystem::path loops;
};
// Returns the places to look for a status. Errors: bad_argument, and those of reading the
// configuration.
[[nodiscard]] Result<StatusPlaces> places_of(const StatusOptions& options);

struct StatusAnswer {
    nlohmann::json document;     // an object
    std::filesystem::path from;  // the socket or the file
    std::string silent;          // why no daemon answered; empty: one did
};
// Gets the status from the first place that has one. Errors: not_found if no place has one; the
// message gives the reason for each place.
[[nodiscard]] Result<StatusAnswer> find_status(const StatusPlaces& places);

// Adds two members to the document if the loops are or were run by a process other than the daemon.
// "loops" lists the loops of that process (marked as stopped if the process is gone), and the loops
// that only the daemon's configuration names. "loops_service" describes the process: "state",
// "pid", "version", "started", "updated", and "alive", which is true if the process exists.
void add_loops(nlohmann::json& document, const std::filesystem::path& loops);

// Returns advice for a user who may not open the socket: "; members of the group GROUP may ask:
// sudo usermod -aG GROUP USER, then log in again". Returns an empty text if the group is unknown.
[[nodiscard]] std::string how_to_be_let_in(const std::filesystem::path& socket);

// Returns the status document of the process that listens on the socket. Waits at most 5 s and
// reads at most 16 MiB. Errors: io with the system's reason; corrupt if the answer is not a status.
[[nodiscard]] Result<nlohmann::json> ask_socket(const std::filesystem::path& path);

}  // namespace stormcellar::cli
