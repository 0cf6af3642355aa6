// pipeline/drop/file_facts.h -- what the catalog is told about a raw file and its volumes.
//
// Inside the pipeline room only. These functions do not open the file.
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

// Distinguishes two states of a file.
struct FileStamp {
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;
    bool regular = false;  // symbolic links are not followed, so they are not regular
    mode_t kind = 0;       // the file type bits of the mode (S_IFMT)
    // When the file got its name or was last changed, by the system's clock, whatever modification
    // time its writer set. A new hard link changes it too, so it does not distinguish two states.
    std::int64_t changed_ns = 0;
    bool operator==(const FileStamp& other) const {
        return size_bytes == other.size_bytes && modified_ns == other.modified_ns &&
               regular == other.regular && kind == other.kind;
    }
};
// not_found if there is no such file below `beneath` (base/beneath.h); otherwise permission or io.
[[nodiscard]] Result<FileStamp> stamp_of(const std::filesystem::path& path,
                                         const std::filesystem::path& beneath = {});

// The time at which a file was written, for comparison with other files of its volume: its own
// modification time, but no later than now. Otherwise a file that claims to be from the future
// would be the newest for good.
[[nodiscard]] std::int64_t believed_ns(std::int64_t modified_ns);

[[nodiscard]] catalog::VolumeFacts facts_of(const level2::Volume& volume, bool damaged);

// The gravest problem in one line, with the number of problems; empty if none counts.
[[nodiscard]] std::string reason_of(const level2::DecodeReport& report);

}  // namespace stormcellar::pipeline
