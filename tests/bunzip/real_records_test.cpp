// Decompresses every record of every real volume on each path and compares it with libbz2, byte by
// byte.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bunzip/bunzip.h"
#include "level2/containers/bzip2_stream.h"
#include "level2/containers/gzip_stream.h"
#include "level2/containers/ldm_framer.h"
#include "tests/bunzip/each_path.h"
#include "tests/bunzip/stream_maker.h"
#include "tests/testing/data.h"

namespace stormcellar::bunzip {
namespace {

namespace fs = std::filesystem;

Bytes bytes_of_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    return level2::without_gzip(bytes_of(text));
}

// Returns the streams of a file, which is one bzip2 stream or LDM records.
std::vector<std::span<const std::byte>> streams_of(const Bytes& file) {
    const std::span<const std::byte> bytes = file;
    if (level2::is_bzip2(bytes)) return {bytes};
    return level2::ldm_records(bytes);
}

TEST(RealRecords, AreWhatLibbz2Makes) {
    STORMCELLAR_NEED_DATA();
    Workspace workspace;
    Bytes buffer;
    int records = 0, files = 0;
    for (const auto& entry :
         fs::recursive_directory_iterator(*::stormcellar::testing::data_directory())) {
        if (!entry.is_regular_file() || entry.path().extension() == ".json") continue;
        const Bytes file = bytes_of_file(entry.path());
        const auto streams = streams_of(file);
        files += streams.empty() ? 0 : 1;
        for (const auto stream : streams) {
            const LibraryOutcome wanted = decompressed(stream, std::size_t{1} << 28);
            for (const Path path : available_kernels()) {
                const Outcome outcome =
                    decompress(stream, buffer, std::size_t{1} << 28, workspace, path);
                ASSERT_EQ(static_cast<int>(outcome.status), static_cast<int>(wanted.status))
                    << entry.path() << " by " << name_of(path);
                ASSERT_EQ(outcome.input_bytes, wanted.input_bytes);
                ASSERT_TRUE(
                    std::equal(wanted.bytes.begin(), wanted.bytes.end(), buffer.begin(),
                               buffer.begin() + static_cast<std::ptrdiff_t>(outcome.output_bytes)))
                    << entry.path() << " by " << name_of(path);
            }
            ++records;
        }
    }
    EXPECT_GT(files, 15);
    EXPECT_GT(records, 500);
    RecordProperty("records", records);
}

}  // namespace
}  // namespace stormcellar::bunzip
