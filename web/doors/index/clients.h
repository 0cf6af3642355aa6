// web/doors/index/clients.h -- how each program connects, with addresses to copy.
//
// Threads   Pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::web {

// Values that are filled into the examples.
struct ClientPlaces {
    std::string base;     // "http://127.0.0.1:8090"
    std::string bucket;   // "unidata-nexrad-level2"
    std::string station;  // "KTLX"
    std::string domain;   // of grids
    std::string moment;   // name of the moment
    std::string day;      // "2026/05/01", day of the newest volume
    std::string when;     // "2026, 5, 1, 12, 0", its time
};

struct ClientHelp {
    std::string_view program;
    std::string_view text;  // a sentence or two
    std::string code;       // to copy
};

// Returns help for the programs whose door is among the prefixes, except where another of these
// doors serves them better. The most used programs come first.
[[nodiscard]] std::vector<ClientHelp> client_help(const ClientPlaces& places,
                                                  const std::vector<std::string>& doors);

}  // namespace stormcellar::web
