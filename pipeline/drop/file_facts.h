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

// A stamp of a file. It tells whether the file has changed.
struct FileStamp {
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;
    bool regular = false;  // false for a symbolic link, because links are not followed
    mode_t kind = 0;       // the S_IFMT part of the mode
    // The time (st_ctim, by this machine's clock) at which the file arrived or last changed. A new
    // hard link changes it, too, so it does not distinguish two states of a file.
    std::int64_t changed_ns = 0;
    bool operator==(const FileStamp& other) const {
        return size_bytes == other.size_bytes && modified_ns == other.modified_ns &&
               regular == other.regular && kind == other.kind;
    }
};
// Returns the stamp of a file. Errors: not_found if there is no such file below `beneath`
// (base/beneath.h); permission; io.
[[nodiscard]] Result<FileStamp> stamp_of(const std::filesystem::path& path,
                                         const std::filesystem::path& beneath = {});

// Describes a volume for the catalog. A volume of a damaged file is never complete.
[[nodiscard]] catalog::VolumeFacts facts_of(const level2::Volume& volume, bool damaged);

// Returns the most severe problem in one line, with the number of further problems. Ignores notes,
// and returns an empty text if there are only notes.
[[nodiscard]] std::string reason_of(const level2::DecodeReport& report);

}  // namespace stormcellar::pipeline
