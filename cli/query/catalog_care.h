// cli/query/catalog_care.h -- `stormcellar catalog check` and `catalog rebuild`.
#pragma once

#include <string>

namespace stormcellar::cli {

struct CareOptions {
    std::string directory;  // state/catalog
    std::string drop;       // drop directory, for rebuild
    std::string station;    // empty: all
    // The stations that count as known: "known" (the station table), "any", or a list of names and
    // "known".
    std::string stations = "known";
    bool clear_unknown = false;  // for check: first removes the databases of unknown stations
    bool json = false;
};

// Check or rebuild the catalog, print the findings, and return the exit status. The status is 0 if
// nothing is wrong, or if a rebuild has repaired everything. Lost rows are reported but are not a
// failure.
int check_catalog(const CareOptions& options);
int rebuild_catalog(const CareOptions& options);

}  // namespace stormcellar::cli
