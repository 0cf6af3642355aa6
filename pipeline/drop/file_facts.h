// pipeline/drop/file_facts.h -- what the catalog is told about a raw file and its volumes.
//
// Inside the pipeline room only. Nothing here opens the file.
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

// What tells two states of a file apart.
struct FileStamp {
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;
    bool regular = false;  // symbolic links are not followed, so they are not regular
    mode_t kind = 0;       // S_IFMT's part of the mode
    // When it came to stand here or was changed last, whatever its writer says of its time: by the
    // clock on the wall. A new hard link counts, too, so it tells no two states apart.
    std::int64_t changed_ns = 0;
    bool operator==(const FileStamp& other) const {
        return size_bytes == other.size_bytes && modified_ns == other.modified_ns &&
               regular == other.regular && kind == other.kind;
    }
};
// not_found when there is no such file below `beneath` (base/beneath.h), else permission or io.
[[nodiscard]] Result<FileStamp> stamp_of(const std::filesystem::path& path,
                                         const std::filesystem::path& beneath = {});

// When a file was written, as it counts against other files of its volume: its own time, and no
// later than now. What claims to be of the future would be the newest for good.
[[nodiscard]] std::int64_t believed_ns(std::int64_t modified_ns);

[[nodiscard]] catalog::VolumeFacts facts_of(const level2::Volume& volume, bool damaged);

// The gravest problem in one line, with how many there are; empty when there are none that count.
[[nodiscard]] std::string reason_of(const level2::DecodeReport& report);

}  // namespace stormcellar::pipeline
