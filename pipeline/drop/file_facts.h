// pipeline/drop/file_facts.h -- collects the facts that the catalog records about a raw file and
// its volumes. Used only inside the pipeline room.
//
// Nothing here opens the file.
//
// Threads   Plain data and functions without state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <sys/stat.h>

#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {

// Tells whether a file has changed.
struct FileStamp {
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;
    bool regular = false;  // symbolic links are not followed, so they are not regular
    mode_t kind = 0;       // the S_IFMT part of the mode
    // The time at which the file arrived or last changed, by this machine's clock (st_ctim). A new
    // hard link also changes this time, so it does not distinguish two states.
    std::int64_t changed_ns = 0;
    bool operator==(const FileStamp& other) const {
        return size_bytes == other.size_bytes && modified_ns == other.modified_ns &&
               regular == other.regular && kind == other.kind;
    }
};
// Returns the stamp of a file. Errors: not_found if there is no such file below `beneath`
// (base/beneath.h), else permission or io.
[[nodiscard]] Result<FileStamp> stamp_of(const std::filesystem::path& path,
                                         const std::filesystem::path& beneath = {});

// Describes a volume for the catalog. A volume of a damaged file is never complete.
[[nodiscard]] catalog::VolumeFacts facts_of(const level2::Volume& volume, bool damaged);

// Returns the most severe problem in one line, with the number of further problems. Notes do not
// count; empty if there are only notes.
[[nodiscard]] std::string reason_of(const level2::DecodeReport& report);

}  // namespace stormcellar::pipeline
