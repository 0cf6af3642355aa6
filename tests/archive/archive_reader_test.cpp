#include "stormcellar/archive/archive_reader.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "stormcellar/base/file_system.h"
#include "tests/archive/archive_maker.h"
#include "tests/archive/two_members.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::archive {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class EveryKind : public ::testing::TestWithParam<Kind> {};

TEST_P(EveryKind, GivesItsMembersInTheirOrder) {
    const auto bytes = make_archive(GetParam(), two);
    auto reader = ArchiveReader::open(bytes);
    ASSERT_TRUE(reader);
    const auto first = reader->next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->name, "a/KTLX_1");
    EXPECT_EQ(first->bytes, bytes_of("first"));
    EXPECT_EQ(first->modified, UtcTime{std::chrono::seconds{1'600'000'000}});
    EXPECT_EQ(reader->next()->bytes, bytes_of("second"));
    EXPECT_FALSE(reader->next());
    EXPECT_THAT(reader->left_out(), IsEmpty());
    EXPECT_FALSE(reader->is_cut());
}

TEST_P(EveryKind, IsReadFromAFileToo) {
    const testing::TemporaryDirectory directory;
    const auto path = directory.path() / "archive";
    ASSERT_TRUE(write_file_atomically(real_file_system(), path, make_archive(GetParam(), two)));
    const int descriptor = ::open(path.c_str(), O_RDONLY);
    auto reader = ArchiveReader::open(descriptor);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), ElementsAre("a/KTLX_1", "KTLX_2"));
    ::close(descriptor);
}

// From an archive that is cut anywhere, the reader returns only whole members, and reports the cut.
TEST_P(EveryKind, CutAnywhereItGivesWhatIsWhole) {
    const auto bytes = make_archive(GetParam(), two);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97) {
        const auto cut = std::span{bytes}.first(size);
        auto reader = ArchiveReader::open(cut);
        if (!reader) continue;
        std::size_t count = 0;
        while (const auto member = reader->next()) {
            ASSERT_LT(count, two.size());
            EXPECT_EQ(member->bytes, two[count++].bytes) << size;
        }
        if (count < two.size()) {
            EXPECT_TRUE(reader->is_cut()) << size;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind,
                         ::testing::Values(Kind::tar, Kind::tar_gz, Kind::tar_bz2,
                                           Kind::tar_compress, Kind::tar_xz, Kind::tar_zst,
                                           Kind::zip));

TEST(ArchiveReader, LevelTwoAndOthersAreNone) {
    EXPECT_FALSE(ArchiveReader::open(bytes_of("")));
    EXPECT_FALSE(ArchiveReader::open(bytes_of("AR2V0006.001")));
    EXPECT_FALSE(ArchiveReader::open(std::vector<std::byte>(100'000)));
}

TEST(ArchiveReader, ZerosAreNone) {
    const std::vector<std::byte> zeros(1'000'000);
    for (const Kind kind : {Kind::tar_gz, Kind::tar_bz2, Kind::tar_xz}) {
        EXPECT_FALSE(ArchiveReader::open(make_archive(kind, {})));
        EXPECT_FALSE(ArchiveReader::open(packed(kind, zeros)));
    }
    EXPECT_FALSE(ArchiveReader::open(zeros));
}

TEST(ArchiveReader, NoRealVolumeIsTakenForAnArchive) {
    STORMCELLAR_NEED_DATA();
    int seen = 0;
    for (const auto& entry : fs::directory_iterator(testing::real_file("volumes"))) {
        const auto bytes = read_file(entry.path());
        ASSERT_TRUE(bytes);
        EXPECT_FALSE(ArchiveReader::open(*bytes)) << entry.path();
        ++seen;
    }
    EXPECT_GT(seen, 10);
}

TEST(ArchiveReader, WhatIsNoFileIsLeftOutAndNamed) {
    const auto bytes = make_archive(Kind::tar, {{"good", bytes_of("x")},
                                                {"soft", {}, Put::What::symlink, "/etc/passwd"},
                                                {"hard", {}, Put::What::hardlink, "good"},
                                                {"pipe", {}, Put::What::fifo},
                                                {"directory/", {}, Put::What::directory},
                                                {"../out", bytes_of("x")},
                                                {"/etc/absolute", bytes_of("x")},
                                                {"a/../../b", bytes_of("x")},
                                                {"good", bytes_of("again")}});
    auto reader = ArchiveReader::open(bytes);
    ASSERT_TRUE(reader);
    EXPECT_THAT(names_of(*reader), ElementsAre("good", "good#2"));
    std::vector<std::string> left_out;
    for (const LeftOut& one : reader->left_out())
        left_out.push_back(one.name + " " + one.reason);
    EXPECT_THAT(left_out,
                ElementsAre("soft is a link", "hard is a link", "pipe is not a regular file",
                            "../out names a place outside the archive",
                            "/etc/absolute names a place outside the archive",
                            "a/../../b names a place outside the archive"));
}

TEST(ArchiveReader, AnArchiveInAnArchiveIsGoneThroughOnce) {
    const auto inner = make_archive(Kind::tar_gz, two);
    const auto middle = make_archive(Kind::zip, {{"inner.tar.gz", inner}, {"c", bytes_of("c")}});
    auto one = ArchiveReader::open(middle);
    EXPECT_THAT(names_of(*one), ElementsAre("inner.tar.gz!a/KTLX_1", "inner.tar.gz!KTLX_2", "c"));
    const auto outer = make_archive(Kind::tar, {{"middle.zip", middle}});
    auto two_deep = ArchiveReader::open(outer);
    // An archive two levels deep is returned as a member. The member is not a volume, so decoding
    // it reports an error.
    EXPECT_THAT(names_of(*two_deep), ElementsAre("middle.zip!inner.tar.gz", "middle.zip!c"));
}

TEST(ArchiveReader, SmallCodecsAloneTakeNoMoreMemoryThanTheyNeed) {
    Limits limits;
    limits.small_codecs = true;
    limits.nesting = 0;
    for (const Kind kind :
         {Kind::tar, Kind::tar_gz, Kind::tar_bz2, Kind::tar_compress, Kind::zip}) {
        const auto bytes = make_archive(kind, two);
        auto reader = ArchiveReader::open(bytes, limits);
        ASSERT_TRUE(reader);
        EXPECT_EQ(names_of(*reader).size(), 2U);
    }
    EXPECT_FALSE(ArchiveReader::open(make_archive(Kind::tar_xz, two), limits));
    EXPECT_FALSE(ArchiveReader::open(make_archive(Kind::tar_zst, two), limits));
    const auto outer = make_archive(Kind::zip, {{"inner.tar", make_archive(Kind::tar, two)}});
    auto nested = ArchiveReader::open(outer, limits);
    EXPECT_THAT(names_of(*nested), ElementsAre("inner.tar"));
}

TEST(ArchiveReader, ItsLastBytesTellWhetherItMayHaveItsEnd) {
    for (const Kind kind : {Kind::tar, Kind::zip}) {
        const auto bytes = make_archive(kind, two);
        EXPECT_TRUE(ArchiveReader::open(bytes)->may_have_its_end());
        const std::size_t less = kind == Kind::tar ? 10'000 : 30;
        const auto cut = std::span{bytes}.first(bytes.size() - std::min(less, bytes.size() / 2));
        const auto reader = ArchiveReader::open(cut);
        ASSERT_TRUE(reader);
        EXPECT_FALSE(reader->may_have_its_end());
    }
}

TEST(MemberPath, IsOneWhereTheArchiveStandsAndThePathDoesNot) {
    const testing::TemporaryDirectory directory;
    const auto archive = directory.path() / "a!b.tar";
    std::ofstream(archive) << "x";
    const auto found = member_path_of(archive.native() + "!dir/KTLX!1");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->archive, archive);
    EXPECT_EQ(found->member, "dir/KTLX!1");
    EXPECT_FALSE(member_path_of(archive));
    EXPECT_FALSE(member_path_of(directory.path() / "none.tar!x"));
}

// 2026-11-29: members after zeros were lost without a report. The zeros were a lost page, or the
// end of the first of two joined tars.
TEST(ArchiveReader, ReadsOnBehindZeros) {
    const auto large = bytes_of(std::string(9000, 'x'));
    const auto first = make_archive(Kind::tar, {{"a", large}, {"b", large}, {"c", large}});
    std::vector<std::byte> lost_page = first;
    constexpr std::size_t header = 512, member = header + 18 * header;
    std::fill_n(lost_page.begin() + member, header, std::byte{0});
    auto reader = ArchiveReader::open(lost_page);
    EXPECT_THAT(names_of(*reader), ElementsAre("a"));
    EXPECT_TRUE(reader->is_cut()) << "the bytes after the zeros are not a header";
    EXPECT_THAT(reader->why_ended(), HasSubstr("Damaged tar archive"));
    EXPECT_EQ(reader->left_out().size(), 1U);

    std::vector<std::byte> longer = first;
    longer.resize(first.size() + 700);
    reader = ArchiveReader::open(longer);
    EXPECT_THAT(names_of(*reader), ElementsAre("a", "b", "c"));
    EXPECT_FALSE(reader->is_cut()) << reader->why_ended();

    const auto second = make_archive(Kind::tar, {{"d", large}, {"b", large}});
    std::vector<std::byte> joined = first;
    joined.insert(joined.end(), second.begin(), second.end());
    reader = ArchiveReader::open(joined);
    EXPECT_THAT(names_of(*reader), ElementsAre("a", "b", "c", "d", "b#2"));
    EXPECT_EQ(reader->why_ended(), "");

    std::vector<std::byte> packed = make_archive(Kind::tar_gz, {{"a", large}});
    const auto more = make_archive(Kind::tar_gz, {{"d", large}});
    packed.insert(packed.end(), more.begin(), more.end());
    reader = ArchiveReader::open(packed);
    EXPECT_THAT(names_of(*reader), ElementsAre("a", "d"));
}

// 2026-11-29: if reading the start of an archive failed once, the file never counted as an archive
// again.
TEST(ArchiveReader, AStartThatCannotBeReadIsNotThatOfAnotherFile) {
    const Descriptor unreadable{::open("/proc/self/mem", O_RDONLY | O_CLOEXEC)};  // EIO at 0
    auto reader = ArchiveReader::open(unreadable.number());
    ASSERT_TRUE(reader);
    EXPECT_TRUE(reader->may_have_its_end());
    EXPECT_FALSE(reader->next());
    EXPECT_TRUE(reader->is_unreadable());
    EXPECT_EQ(find_member(unreadable.number(), "KTLX").error().code, ErrorCode::io);
}

// 2026-11-29: for a member after the place where an archive is cut, the error said that the member
// was not in the archive, or was gone.
TEST(ArchiveReader, SaysWhyAMemberIsMissing) {
    std::vector<std::byte> tar = make_archive(Kind::tar, {{"a", bytes_of(std::string(2000, 'a'))},
                                                          {"b", bytes_of(std::string(9000, 'b'))},
                                                          {"c", bytes_of("c")}});
    auto whole = ArchiveReader::open(tar);
    while (whole->next()) {
    }
    EXPECT_EQ(whole->why_missing("d"), "is not in the archive");
    EXPECT_EQ(whole->why_ended(), "");
    tar.resize(6000);
    auto cut = ArchiveReader::open(tar);
    ASSERT_TRUE(cut->next());
    EXPECT_FALSE(cut->next());
    EXPECT_THAT(cut->why_missing("b"), StartsWith("is cut or damaged"));
    EXPECT_THAT(cut->why_missing("c"), StartsWith("the archive cannot be read behind b"));
    EXPECT_FALSE(cut->is_unreadable());
}

}  // namespace
}  // namespace stormcellar::archive
