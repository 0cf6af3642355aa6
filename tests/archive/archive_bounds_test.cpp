// Reads archives that were made to take much time, memory or disk, and tests that reading ends at
// its bounds.
#include <chrono>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "archive/packed_stream.h"
#include "stormcellar/archive/archive_reader.h"
#include "tests/archive/archive_maker.h"
#include "tests/archive/two_members.h"

namespace stormcellar::archive {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ArchiveReader, BombsStopAtTheLimits) {
    const std::vector<std::byte> zeros(std::size_t{8} << 20);
    Limits limits;
    limits.unbounded_bytes = 1 << 20;
    const auto bomb = make_archive(Kind::tar_gz, {{"a", zeros}, {"b", bytes_of("b")}});
    auto reader = ArchiveReader::open(bomb, limits);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), IsEmpty());
    EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("unpacks to more than"));

    limits = {};
    limits.member_bytes = 1 << 20;
    auto large = ArchiveReader::open(bomb, limits);
    EXPECT_THAT(names_of(*large), ElementsAre("b"));
    EXPECT_THAT(large->left_out().at(0).reason, HasSubstr("has more than 1048576 bytes"));

    limits = {};
    limits.members = 3;
    std::vector<Put> many(10, Put{"x", bytes_of("x")});
    auto crowd_bytes = make_archive(Kind::tar, many);
    auto crowd = ArchiveReader::open(crowd_bytes, limits);
    EXPECT_EQ(names_of(*crowd).size(), 3U);
    EXPECT_THAT(crowd->left_out().at(0).reason, HasSubstr("more than 3 members"));
}

// 2026-11-25: libarchive unpacked members to skip them, and nothing counted the unpacked bytes.
TEST(ArchiveReader, WhatIsPassedOverCountsToo) {
    const std::vector<std::byte> zeros(std::size_t{8} << 20);
    Limits limits;
    limits.unbounded_bytes = 1 << 20;
    for (const Kind kind : {Kind::tar_gz, Kind::tar_bz2, Kind::tar_xz, Kind::tar_zst, Kind::zip}) {
        // The name of the first member is refused, so its data are skipped.
        const auto bomb = make_archive(kind, {{"../a", zeros}, {"b", bytes_of("b")}});
        auto reader = ArchiveReader::open(bomb, limits);
        ASSERT_TRUE(reader);
        EXPECT_THAT(names_of(*reader), IsEmpty()) << int(kind);
        EXPECT_THAT(reader->left_out().back().reason, HasSubstr("unpacks to more than"));
        EXPECT_FALSE(reader->is_cut());
    }
}

std::size_t peak_bytes() {
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

// Returns a tar header made by hand, because libarchive's writer makes no false headers.
std::vector<std::byte> tar_header(const std::string& name, std::size_t size, char type) {
    std::string block(512, '\0');
    const auto put = [&](std::size_t at, const std::string& text) {
        block.replace(at, text.size(), text);
    };
    put(0, name);
    put(100, "0000644");
    put(108, "0000000");
    put(116, "0000000");
    put(124, fmt::format("{:011o}", size));
    put(136, "00000000000");
    put(148, "        ");
    block[156] = type;
    put(257, std::string("ustar\00000", 8));
    unsigned sum = 0;
    for (const char c : block)
        sum += static_cast<unsigned char>(c);
    put(148, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
    return bytes_of(block);
}

// Returns a record of a pax header, which begins with its own length.
std::string record(const std::string& text) {
    std::size_t length = text.size() + 3;
    while (fmt::format("{} {}\n", length, text).size() != length)
        ++length;
    return fmt::format("{} {}\n", length, text);
}

// Returns a tar of files of one byte, each after a pax header with these records.
std::vector<std::byte> tar_with_headers(const std::string& pax, int files) {
    std::vector<std::byte> tar;
    const auto add = [&](const std::vector<std::byte>& bytes) {
        tar.insert(tar.end(), bytes.begin(), bytes.end());
        tar.resize((tar.size() + 511) / 512 * 512);
    };
    for (int i = 0; i < files; ++i) {
        add(tar_header("PaxHeaders/x", pax.size(), 'x'));
        add(bytes_of(pax));
        add(tar_header(fmt::format("{}", i), 1, '0'));
        add(bytes_of("b"));
    }
    tar.resize(tar.size() + 1024);
    return tar;
}

// Returns a tar with a plain file and a sparse file in GNU's format 1.0. The data of the sparse
// file begin with a map of `entries` entries.
std::vector<std::byte> sparse_tar(std::size_t entries) {
    const std::string pax = record("GNU.sparse.major=1") + record("GNU.sparse.minor=0") +
                            record("GNU.sparse.name=KTLX") + record("GNU.sparse.realsize=4");
    std::string map = fmt::format("{}\n", entries);
    for (std::size_t i = 0; i < entries; ++i)
        map += "0\n0\n";
    map.resize((map.size() + 511) / 512 * 512);
    std::vector<std::byte> tar = tar_header("PaxHeaders/x", pax.size(), 'x');
    const auto add = [&](std::string text) {
        text.resize((text.size() + 511) / 512 * 512);
        const auto more = bytes_of(text);
        tar.insert(tar.end(), more.begin(), more.end());
    };
    const auto add_header = [&](const std::vector<std::byte>& header) {
        tar.insert(tar.end(), header.begin(), header.end());
    };
    add(pax);
    add_header(tar_header("GNUSparseFile.0/KTLX", map.size(), '0'));
    add(map);
    add_header(tar_header("b", 1, '0'));
    add("b");
    add(std::string(1024, '\0'));
    return tar;
}

// 2026-11-28: a packed tar of 257 kB took 3 GiB of memory. libarchive keeps 48 bytes for each 4
// bytes of the map of a sparse file while it reads the header, and no limit applied then.
TEST(ArchiveReader, AHeaderThatIsTooLongEndsIt) {
    const auto tar = sparse_tar(2'000'000);
    for (const auto& bytes : {tar, packed(Kind::tar_gz, tar)}) {
        const std::size_t before = peak_bytes();
        auto reader = ArchiveReader::open(bytes);
        ASSERT_TRUE(reader);
        EXPECT_THAT(names_of(*reader), IsEmpty());
        ASSERT_EQ(reader->left_out().size(), 1U);
        EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("header that is too long"));
        EXPECT_FALSE(reader->is_cut()) << "the daemon must not wait for the end";
        EXPECT_TRUE(reader->may_have_its_end());
        EXPECT_LT(peak_bytes() - before, std::size_t{48} << 20);
    }
}

// 2026-11-28: in a file of 202 kB, one header with an access list of 889 kB took 47 s, and with
// four such headers the watchdog ended the daemon. libarchive compares each entry with all previous
// entries.
TEST(ArchiveReader, AnAccessListWithoutAnEndIsNotRead) {
    std::string entries;
    for (int i = 0; i < 30'000; ++i)
        entries += fmt::format("u:{}:r,", i);
    const auto tar = tar_with_headers(record("SCHILY.acl.access=" + entries), 1);
    for (const auto& bytes : {tar, packed(Kind::tar_gz, tar)}) {
        auto reader = ArchiveReader::open(bytes);
        ASSERT_TRUE(reader);
        EXPECT_THAT(names_of(*reader), IsEmpty());
        EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("header that is too long"));
    }
}

TEST(ArchiveReader, ManyLongHeadersEndItToo) {
    const auto names = [](std::size_t comment, int files) {
        const auto tar = tar_with_headers(record("comment=" + std::string(comment, 'c')), files);
        std::vector<std::size_t> counts;
        for (const auto& bytes : {tar, packed(Kind::tar_gz, tar)}) {
            auto reader = ArchiveReader::open(bytes);
            counts.push_back(reader ? names_of(*reader).size() : 0);
            EXPECT_EQ(reader->left_out().empty(), counts.back() == std::size_t(files));
        }
        EXPECT_EQ(counts[0], counts[1]);
        return counts[0];
    };
    EXPECT_EQ(names(6'000, 1'000), 1'000U) << "ordinary archives have such headers";
    EXPECT_EQ(names(100'000, 30), 30U);
    EXPECT_LT(names(100'000, 60), 50U);
}

// 2026-11-28: the skipped bytes of each archive inside an archive had a bound of their own.
TEST(ArchiveReader, WhatInnerArchivesPassOverCountsToo) {
    const std::vector<std::byte> zeros(std::size_t{8} << 20);
    const auto bomb = make_archive(Kind::tar_gz, {{"../a", zeros}, {"b", bytes_of("b")}});
    Limits limits;
    limits.unbounded_bytes = std::size_t{10} << 20;
    limits.expansion = 1;
    const std::vector<Put> bombs(10, Put{"bomb.tar.gz", bomb});
    const auto tar = make_archive(Kind::tar, bombs);
    auto reader = ArchiveReader::open(tar, limits);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), ElementsAre("bomb.tar.gz!b", "bomb.tar.gz#2!b"));
    EXPECT_THAT(reader->left_out().back().reason, HasSubstr("unpacks to too many bytes"));
}

TEST(ArchiveReader, ANameOfGzipWithoutAnEndTakesNoMemory) {
    std::vector<std::byte> gzip = packed(Kind::tar_gz, bytes_of("x"));
    gzip[3] = std::byte{8};  // a name comes after the header
    gzip.resize(std::size_t{64} << 20, std::byte{'n'});
    const std::size_t before = peak_bytes();
    EXPECT_FALSE(ArchiveReader::open(gzip));
    EXPECT_LT(peak_bytes() - before, std::size_t{24} << 20);
}

// 2026-11-28: libarchive looked for a second filter after the first, and kept all unpacked bytes of
// an endless name in a gzip header: gigabytes from a file of some kilobytes.
TEST(ArchiveReader, ANameOfGzipInABzip2TakesNoMemory) {
    std::vector<std::byte> name(std::size_t{8} << 20, std::byte{'n'});
    const auto more = packed(Kind::tar_bz2, name);
    std::ranges::copy(bytes_of(std::string("\x1F\x8B\x08\x08", 4)), name.begin());
    auto bomb = packed(Kind::tar_bz2, name);
    for (int i = 0; i < 15; ++i)
        bomb.insert(bomb.end(), more.begin(), more.end());
    const std::size_t before = peak_bytes();
    EXPECT_FALSE(ArchiveReader::open(bomb));
    EXPECT_LT(peak_bytes() - before, std::size_t{24} << 20);
}

// Returns a zip with a member packed by LZMA. The header of the member asks for a dictionary of 1
// GiB, and the length of the member follows its data.
std::vector<std::byte> zip_of_lzma() {
    std::string zip("PK\x03\x04\x3F\0\x08\0\x0E\0", 10);
    zip += std::string(16, '\0') + std::string("\x01\0\0\0x", 5);
    zip += std::string("\x10\x02\x05\0\x5D\0\0\0\x40", 9) + std::string(100'000, '\0');
    return bytes_of(zip);
}

// libarchive would unpack a member of zip_of_lzma() to find the end of the member, and would take
// as much memory as the header asks for.
TEST(ArchiveReader, SmallCodecsAloneEndAZipThatIsReadFromItsStart) {
    Limits limits;
    limits.small_codecs = true;
    const auto zip = zip_of_lzma();
    for (const auto& bytes : {zip, packed(Kind::tar_gz, zip)}) {
        const std::size_t before = peak_bytes();
        auto reader = ArchiveReader::open(bytes, limits);
        ASSERT_TRUE(reader);
        EXPECT_THAT(names_of(*reader), IsEmpty());
        ASSERT_EQ(reader->left_out().size(), 2U);
        EXPECT_EQ(reader->left_out().at(0).reason, "is packed in a way that may take much memory");
        EXPECT_LT(peak_bytes() - before, std::size_t{24} << 20);
    }
}

TEST(ArchiveReader, WhatTakesTooLongEndsIt) {
    const std::vector<std::byte> zeros(std::size_t{8} << 20);
    Limits limits;
    limits.time = std::chrono::seconds{0};
    for (const Kind kind : {Kind::tar_gz, Kind::tar_bz2}) {
        const auto archive = make_archive(kind, {{"../a", zeros}, {"b", bytes_of("b")}});
        auto reader = ArchiveReader::open(archive, limits);
        ASSERT_TRUE(reader);
        EXPECT_THAT(names_of(*reader), IsEmpty());
        EXPECT_THAT(reader->left_out().back().reason, HasSubstr("takes too long to read"));
        EXPECT_FALSE(reader->is_cut());
    }
}

// 2026-11-28: in one call, libarchive unpacked 140 GiB of a zip of 146 MB, to find the end of data
// that belong to a directory, and the watchdog ended the service.
TEST(ArchiveReader, ADirectoryOfAZipThatHasDataEndsItInTime) {
    // In a gzip file, the deflated data come after 10 bytes and before the checksum and the length.
    const std::vector<std::byte> gzip =
        packed(Kind::tar_gz, std::vector<std::byte>(std::size_t{64} << 20));
    const std::string text(reinterpret_cast<const char*>(gzip.data()), gzip.size());
    const std::string deflated = text.substr(10, text.size() - 18);
    std::string zip = std::string("PK\x03\x04\x14\0\x08\0\x08\0", 10) + std::string(16, '\0') +
                      std::string("\x02\0\0\0d/", 6) + deflated + "PK\x07\x08" +
                      text.substr(text.size() - 8, 4);
    for (const std::size_t size : {deflated.size(), std::size_t{64} << 20})
        for (int i = 0; i < 4; ++i)
            zip += static_cast<char>(size >> (8 * i));
    Limits limits;
    limits.time = std::chrono::seconds{0};
    const auto bytes = bytes_of(zip);
    auto reader = ArchiveReader::open(bytes, limits);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), IsEmpty());
    ASSERT_FALSE(reader->left_out().empty());
    EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("takes too long to read"));
}

TEST(ArchiveReader, ASparseFileIsLeftOut) {
    const auto tar = sparse_tar(2);
    auto reader = ArchiveReader::open(tar);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), ElementsAre("b"));
    EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("sparse"));
}

TEST(ArchiveReader, AZipsDirectoryIsBounded) {
    std::vector<Put> many;
    for (int i = 0; i < 90'000; ++i)
        many.push_back({fmt::format("{}{:06}", std::string(180, 'n'), i), {}});
    const auto zip = make_archive(Kind::zip, many);
    auto reader = ArchiveReader::open(zip);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), IsEmpty());
    EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("header that is too long"));
}

TEST(ArchiveReader, AnArchiveThatIsTooLargeIsNotRead) {
    Limits limits;
    limits.archive_bytes = 1000;
    const auto tar = make_archive(Kind::tar, two);
    auto reader = ArchiveReader::open(tar, limits);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), IsEmpty());
    EXPECT_THAT(reader->left_out().at(0).reason, HasSubstr("has more than 1000 bytes"));
}

TEST(ArchiveReader, WhatIsPackedTwiceIsNone) {
    const auto once = make_archive(Kind::tar_gz, two);
    EXPECT_TRUE(ArchiveReader::open(once));
    for (const Kind kind :
         {Kind::tar_gz, Kind::tar_bz2, Kind::tar_compress, Kind::tar_xz, Kind::tar_zst}) {
        EXPECT_FALSE(ArchiveReader::open(packed(kind, once)));
    }
    EXPECT_FALSE(
        ArchiveReader::open(packed(Kind::tar_compress, make_archive(Kind::tar_compress, two))));
}

// A file in the format of compress: `start`, and any number of copies of `repeated`.
struct EndlessCompressed {
    std::string start, repeated;
};
// Packs `prefix` and then endless repetitions of `period`, with codes of up to `most_width` bits.
// Each copy of `repeated` unpacks to many periods.
EndlessCompressed compressed_without_end(const std::string& prefix, const std::string& period,
                                         unsigned most_width) {
    const unsigned full = 1U << most_width;
    const auto at = [&](std::size_t i) {
        return i < prefix.size() ? prefix[i] : period[(i - prefix.size()) % period.size()];
    };
    EndlessCompressed made{"\x1F\x9D", {}};
    made.start += static_cast<char>(0x80 | most_width);
    std::map<std::pair<unsigned, char>, unsigned> known;
    unsigned next = 257, width = 9, buffer = 0, buffered = 0, written = 0;
    for (std::size_t i = 0;;) {
        unsigned code = static_cast<unsigned char>(at(i));
        std::size_t end = i + 1, periods_end = 0;
        unsigned code_of_periods = 0;
        for (auto longer = known.find({code, at(end)}); longer != known.end();
             longer = known.find({code, at(end)})) {
            code = longer->second;
            ++end;
            if (i >= prefix.size() && (end - i) % period.size() == 0)
                code_of_periods = code, periods_end = end;
        }
        if (next >= full && width == most_width && buffered == 0 && periods_end != 0) {
            std::uint64_t codes = 0;
            const unsigned bits = std::lcm(8U, most_width);
            for (unsigned shift = 0; shift < bits; shift += most_width)
                codes |= std::uint64_t{code_of_periods} << shift;
            for (unsigned shift = 0; shift < bits; shift += 8)
                made.repeated += static_cast<char>(codes >> shift);
            return made;
        }
        buffer |= code << buffered;
        for (buffered += width; buffered >= 8; buffered -= 8, buffer >>= 8)
            made.start += static_cast<char>(buffer);
        if (++written > 1 && 256 + written >= (1U << width) && width < most_width) ++width;
        if (next < full) known[{code, at(end)}] = next++;
        i = end;
    }
}

// 2026-11-28: the daemon took three minutes for 60 kB, without a sign to its watchdog.
TEST(ArchiveReader, WhatIsCompressedTwiceAndUnpacksToNothingTakesNoTime) {
    using namespace std::string_literals;
    // The inner file has only reset codes, nine bytes each, and unpacks to nothing.
    const auto once =
        compressed_without_end("\x1F\x9D\x90\0\1\0\0\0\0"s, "\0\1\0\0\0\0\0\0\0"s, 12);
    const auto twice = compressed_without_end(once.start, once.repeated, 14);
    std::string file = twice.start;
    for (int i = 0; i < 3000; ++i)
        file += twice.repeated;
    bool is_read = false;
    ReadBudget budget;
    const auto stream = PackedStream::open(
        bytes_of(file),
        [&](::archive*) {
            is_read = true;
            return false;
        },
        budget, true, [](std::uint64_t bytes) { return bytes; });
    EXPECT_FALSE(stream);
    EXPECT_FALSE(is_read) << "the first bytes suffice to refuse the file";
    EXPECT_FALSE(ArchiveReader::open(bytes_of(file)));
}

}  // namespace
}  // namespace stormcellar::archive
