// Two members for test archives, and a function that reads the names in an archive.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/archive/archive_reader.h"
#include "tests/archive/archive_maker.h"

namespace stormcellar::archive {

inline const std::vector<Put> two = {{"a/KTLX_1", bytes_of("first")},
                                     {"KTLX_2", bytes_of("second")}};

// Reads the archive to its end, and returns the names of its members.
inline std::vector<std::string> names_of(ArchiveReader& reader) {
    std::vector<std::string> names;
    while (const auto member = reader.next())
        names.push_back(member->name);
    return names;
}

}  // namespace stormcellar::archive
