// Two members for archives of tests, and the names that a reader gives.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/archive/archive_reader.h"
#include "tests/archive/archive_maker.h"

namespace stormcellar::archive {

inline const std::vector<Put> two = {{"a/KTLX_1", bytes_of("first")},
                                     {"KTLX_2", bytes_of("second")}};

// Reads the archive to its end.
inline std::vector<std::string> names_of(ArchiveReader& reader) {
    std::vector<std::string> names;
    while (const auto member = reader.next())
        names.push_back(member->name);
    return names;
}

}  // namespace stormcellar::archive
