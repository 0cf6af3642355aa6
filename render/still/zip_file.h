// render/still/zip_file.h -- writes a zip archive of a few members without compression, because
// pictures are compressed already.
//
// Source    APPNOTE.TXT 6.3 (PKWARE), sections 4.3.7, 4.3.12 and 4.3.16. All members have the same
//           date, so the same members give the same bytes.
// Threads   Pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

struct ZipMember {
    std::string name;  // in ASCII
    std::vector<std::byte> bytes;
};

// Writes an archive. Errors: unsupported for more than 4 GiB or 65,535 members, the most that a zip
// can have.
[[nodiscard]] Result<std::vector<std::byte>> write_zip(const std::vector<ZipMember>& members);

}  // namespace stormcellar::render
