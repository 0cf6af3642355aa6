// Runs the real program on files and directories that could take all memory or time: huge files,
// and small files that unpack to huge contents.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/hostile_drop.h"
#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using nlohmann::json;
using wire::Bytes;

using HostileSizes = HostileDrop;

TEST_F(HostileSizes, HugeSparseFilesAreRefusedBySize) {
    constexpr std::uintmax_t tebibyte = std::uintmax_t{1} << 40U;
    const Bytes messages = wire::radial_messages(2, 360);
    const Bytes begun = wire::join(
        {wire::archive_header(), wire::ldm_record(std::span{messages}.first(messages.size() / 2))});
    put(drop() / "zeros", {});
    put(drop() / "KTLX_before", begun);
    for (const char* name : {"zeros", "KTLX_before"})
        fs::resize_file(drop() / name, tebibyte);
    start();
    put(drop() / "KTLX/7/20220317-000842-001-S", begun);
    put(drop() / "KTLX_growing", begun);
    ASSERT_TRUE(daemon_.wait_for_log("drop/KTLX_growing")) << daemon_.log();
    fs::resize_file(drop() / "KTLX/7/20220317-000842-001-S", tebibyte);
    for (std::uintmax_t size = 1U << 20U; size <= tebibyte; size *= 4)
        fs::resize_file(drop() / "KTLX_growing", size);
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(wait_until_rejected(4)) << daemon_.log();
    for (const char* name : {"zeros", "KTLX_before", "20220317-000842-001-S", "KTLX_growing"}) {
        EXPECT_EQ(reason_of(name),
                  "has 1099511627776 bytes, more than the 268435456 that a raw file may have; it "
                  "was not read")
            << name;
    }
    expect_bounded("sparse files of 1 TiB");
    EXPECT_EQ(daemon_.terminate(), 0);
}

// The largest files that are still read: a file of zeros, and a volume followed by zeros.
TEST_F(HostileSizes, SparseFilesBelowTheLimitAreReadAndStayBounded) {
    for (int i = 0; i < 4; ++i) {
        const fs::path path = drop() / ("KTLX_" + std::to_string(i));
        put(path, i % 2 == 0 ? Bytes{} : volume());
        fs::resize_file(path, (std::uintmax_t{256} << 20U) - 1);
    }
    start();
    ASSERT_TRUE(wait_until_rejected(2)) << daemon_.log();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    expect_bounded("sparse files of 256 MiB");
    EXPECT_EQ(daemon_.terminate(), 0);
}

// Returns `records` compressed records of some 90 bytes; each unpacks to 45 MB.
Bytes bomb_records(unsigned records) {
    static const Bytes stream = wire::bzip2(Bytes(45'000'000));
    const Bytes record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    Bytes all;
    for (unsigned i = 0; i < records; ++i)
        all.insert(all.end(), record.begin(), record.end());
    return all;
}

Bytes first_record() {
    const Bytes messages = wire::radial_messages(2, 360);
    return wire::join(
        {wire::archive_header(), wire::ldm_record(std::span{messages}.first(messages.size() / 2))});
}

TEST_F(HostileSizes, BombsOfBzip2AreRejectedAndAGoodVolumeBesideIsGridded) {
    const Bytes bomb = wire::join({first_record(), bomb_records(1000)});
    std::printf("%zu bytes that unpack to 45 GB\n", bomb.size());
    for (int i = 0; i < 3; ++i)
        put(drop() / ("KTLX_bomb" + std::to_string(i)), bomb);
    put(drop() / "KTLX_packed", wire::bzip2(wire::join({first_record(), bomb_records(20)})));
    start();
    for (int i = 3; i < 6; ++i)
        put(drop() / ("KTLX_bomb" + std::to_string(i)), bomb);
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    const double latency = daemon_.status()["volumes"][0]["latency_s"];
    std::printf("the good volume was gridded %.2f s after its close\n", latency);
    ASSERT_TRUE(wait_until_rejected(7)) << daemon_.log();
    for (const char* name : {"KTLX_bomb0", "KTLX_bomb5", "KTLX_packed"})
        EXPECT_NE(reason_of(name).find("limit"), std::string::npos) << name << reason_of(name);
    expect_bounded("bombs of bzip2");
    EXPECT_EQ(daemon_.terminate(), 0);
}

TEST_F(HostileSizes, BombsThatGrowOrComeAsChunksAreGivenUp) {
    start();
    put(drop() / "KTLX_growing", first_record());
    ASSERT_TRUE(daemon_.wait_for_log("drop/KTLX_growing")) << daemon_.log();
    const Bytes record = bomb_records(1);
    for (int i = 0; i < 20; ++i) {
        append_to_file(drop() / "KTLX_growing",
                       {reinterpret_cast<const char*>(record.data()), record.size()});
        testing::pass_time(std::chrono::milliseconds{20});
    }
    for (int site = 0; site < 2; ++site) {
        const fs::path directory = drop() / "KTLX" / std::to_string(site);
        put(directory / "20220317-000842-001-S", first_record());
        for (int i = 2; i < 12; ++i) {
            const std::string number = (i < 10 ? "00" : "0") + std::to_string(i);
            put(directory / ("20220317-000842-" + number + "-I"), record);
        }
    }
    ASSERT_TRUE(daemon_.wait_for([&](const json&) { return !reason_of("KTLX_growing").empty(); }))
        << daemon_.log();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    expect_bounded("bombs that grow or come as chunks");
    EXPECT_EQ(daemon_.terminate(), 0);
}

TEST_F(HostileSizes, BombsOfGzipAndCompressAreRejected) {
    const Bytes zeros(std::size_t{300} << 20U);
    const Bytes packed = wire::gzip(zeros);
    put(drop() / "KTLX_gzip.gz", packed);
    put(drop() / "KTLX_twice.gz", wire::gzip(packed));
    put(drop() / "KTLX_bzip2.bz2", wire::bzip2(zeros));
    put(drop() / "KTLX_compress.Z", wire::compress(zeros, 16, 0));
    for (const auto& entry : fs::directory_iterator(drop()))
        std::printf("%s: %ju bytes\n", entry.path().filename().c_str(), entry.file_size());
    begin_ = std::chrono::steady_clock::now();
    start();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(wait_until_rejected(4)) << daemon_.log();
    for (const char* name : {"KTLX_gzip.gz", "KTLX_twice.gz", "KTLX_bzip2.bz2", "KTLX_compress.Z"})
        EXPECT_NE(reason_of(name), "") << name;
    expect_bounded("bombs of gzip, bzip2 and compress");
    EXPECT_EQ(daemon_.terminate(), 0);
}

// Makes nested directories, each named "d".
void make_deep(const fs::path& top, int depth) {
    int at = ::open(top.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (int i = 0; i < depth; ++i) {
        ASSERT_EQ(::mkdirat(at, "d", 0755), 0);
        const int below = ::openat(at, "d", O_PATH | O_DIRECTORY | O_CLOEXEC);
        ::close(at);
        at = below;
    }
    ::close(at);
}

// std::filesystem::remove_all() would run out of descriptors here; rm does not.
void remove_deep(const fs::path& top) {
    ASSERT_EQ(testing::run_program("/bin/rm", {"-rf", top.native()}).status, 0);
}

TEST_F(HostileSizes, DeepAndWideDirectoriesAreBounded) {
    fs::create_directory(drop() / "old");
    make_deep(drop() / "old", 1'000);
    for (int i = 0; i < 2000; ++i)
        fs::create_directories(drop() / "wide" / std::to_string(i));
    start();
    fs::create_directory(drop() / "new");
    make_deep(drop() / "new", 300);
    const std::string long_name(250, 'n');
    fs::path path = drop();
    for (int i = 0; i < 15; ++i)
        path /= long_name;
    fs::create_directories(path);
    const int at = ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    const int file = ::openat(at, std::string(255, 'f').c_str(), O_WRONLY | O_CREAT, 0644);
    ::close(file);
    ::close(at);
    put(drop() / "wide/1999/KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(was_said(": is more than 16 directories deep, so it is not read"));
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) { return s["scans"] >= scans + 2; }));
    EXPECT_LT(daemon_.status()["directories"], 2000 + 2 * 20 + 20);
    EXPECT_EQ(daemon_.status()["failures"], 0) << daemon_.log();
    expect_bounded("1,000 directories deep, 2,000 wide");
    EXPECT_EQ(daemon_.terminate(), 0);
    remove_deep(drop() / "old");
    remove_deep(drop() / "new");
}

}  // namespace
}  // namespace stormcellar::daemon
