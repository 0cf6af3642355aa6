// Tests how the files of an archive are listed, and how a task gets the files.
#include "batch/source.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/archive/archive_maker.h"
#include "tests/batch/small_archive.h"
#include "tests/fetch/mock_bucket.h"

namespace stormcellar::batch {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

void write(const fs::path& path, const std::string& text = "x") {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

// An archive of files and tars in a directory, and the recipe of one of its hours.
class Source : public ::testing::Test {
  protected:
    Source() {
        recipe_.source = directory_.path().native();
        recipe_.from = at("2013-05-20T20:00Z");
        recipe_.to = at("2013-05-20T21:00Z");
    }
    // Writes the first bytes of a tar of these members.
    void write_tar(const std::string& name, const std::vector<archive::Put>& puts,
                   std::size_t most_bytes = std::string::npos) {
        const auto tar = archive::make_archive(archive::Kind::tar, puts);
        write(directory_ / name,
              {reinterpret_cast<const char*>(tar.data()), std::min(tar.size(), most_bytes)});
    }
    SourceListing list() {
        const auto listing = list_source(recipe_.source, at("2013-05-20"), at("2013-05-22"));
        EXPECT_TRUE(listing);
        return listing.value();
    }
    Result<BroughtFiles> bring(const StationDay& day) {
        return batch::bring(recipe_, day, scratch_.path(), stop_);
    }
    BroughtFiles bring_first_day() {
        auto brought = bring(list().days.at(0));
        EXPECT_TRUE(brought) << brought.error().message;
        return std::move(brought).value();
    }
    // Expects that the listing and the task both report one missing file.
    void expect_one_left_out(const std::string& path, const std::string& reason) {
        EXPECT_THAT(list().cut, ElementsAre(HasSubstr(reason)));
        const BroughtFiles brought = bring_first_day();
        ASSERT_EQ(brought.left_out.size(), 1U);
        EXPECT_EQ(brought.left_out[0].path, path);
    }

    testing::TemporaryDirectory directory_, scratch_;
    Recipe recipe_;
    const std::atomic<bool> stop_{false};
};

std::vector<std::string> names_of(const BroughtFiles& brought) {
    std::vector<std::string> names;
    for (const fs::path& path : brought.files)
        names.push_back(path.filename().native());
    return names;
}

TEST_F(Source, AVolumeIsKnownByItsName) {
    const auto usual = volume_named("KTLX20130520_200356_V06.gz");
    ASSERT_TRUE(usual);
    EXPECT_EQ(usual->station, "KTLX");
    EXPECT_EQ(usual->start, at("2013-05-20T20:03:56Z"));
    const auto of_ncei = volume_named("6500KTLX19910720_160529.Z");
    ASSERT_TRUE(of_ncei);
    EXPECT_EQ(of_ncei->start, at("1991-07-20T16:05:29Z"));
    for (const char* name : {"KTLX20130520_200356_V06_MDM", "KTLX_any", "notes.txt", "",
                             "KTLX20131520_200356", "XXXX20130520_200356"}) {
        EXPECT_FALSE(volume_named(name)) << name;
    }
}

TEST_F(Source, ListsADirectoryByDayAndStation) {
    write(directory_ / "b/KTLX20130520_200356", "12345");
    write(directory_ / "a/KTLX20130520_235959", "123");
    write(directory_ / "a/KTLX20130521_000500");
    write(directory_ / "a/KFDR20130521_000400");
    write(directory_ / "a/KFDR20130523_000400");  // after the range
    write(directory_ / "a/.KFDR20130521_000900");
    write(directory_ / "a/KFDR20130521_000900.part");
    write(directory_ / "a/readme");
    // 2026-11-28: a plan replaced the byte EF of this name, so its task never found the files.
    write(directory_ / "d\xEFx/KTLX20130521_001500");
    const SourceListing listing = list();
    ASSERT_EQ(listing.days.size(), 3U);
    EXPECT_EQ(listing.days[0].station, "KTLX");
    EXPECT_THAT(listing.days[0].in, ElementsAre("a", "b"));
    EXPECT_EQ(listing.days[0].files, 2U);
    EXPECT_EQ(listing.days[0].bytes, 8U);
    EXPECT_EQ(listing.days[1].station, "KFDR");
    EXPECT_EQ(listing.days[2].station, "KTLX");
    EXPECT_EQ(listing.nameless, 2U);
    EXPECT_THAT(listing.first_nameless, AnyOf("a/readme", "d\\xEFx", "d\\xefx"));
    EXPECT_EQ(listing.links, 0U);
    EXPECT_EQ(list_source((directory_ / "none").native(), {}, {}).error().code,
              ErrorCode::not_found);
}

TEST_F(Source, BringsTheFilesOfARangeInTheirOrder) {
    for (const char* name : {"KTLX20130520_200356", "KTLX20130520_210000", "KTLX20130520_220000",
                             "KFDR20130520_210000"})
        write(directory_ / "day" / name);
    write(directory_ / "again/KTLX20130520_203000");
    recipe_.from = at("2013-05-20T20:30Z");
    const StationDay what{
        std::chrono::floor<std::chrono::days>(recipe_.from), "KTLX", {"again", "day"}, 2, 2};
    const auto own = bring(what);
    ASSERT_TRUE(own);
    EXPECT_THAT(names_of(*own), ElementsAre("KTLX20130520_203000", "KTLX20130520_210000"));
    // Frames need the volumes around the range, too.
    recipe_.domain = pipeline::small_domain();
    recipe_.to = at("2013-05-20T21:40Z");
    EXPECT_THAT(names_of(*bring(what)),
                ElementsAre("KTLX20130520_203000", "KTLX20130520_210000", "KTLX20130520_220000"));
}

// 2026-11-29: links were skipped without a report.
TEST_F(Source, LinksAreNotFollowedAndCounted) {
    const testing::TemporaryDirectory other;
    write(directory_ / "KTLX20130520_200356");
    write(other / "KTLX20130520_210000");
    fs::create_directory_symlink(other.path(), directory_ / "2012");
    fs::create_symlink(other / "KTLX20130520_210000", directory_ / "KTLX20130520_210000");
    const SourceListing listing = list();
    EXPECT_EQ(listing.days.at(0).files, 1U);
    EXPECT_EQ(listing.links, 2U);
    EXPECT_EQ(listing.first_link.parent_path(), directory_.path());
}

// 2026-11-29: a file that had the name of a tar but was not a tar was reported as having no station
// and time in its name.
TEST_F(Source, WhatIsNamedAsATarAndIsNoneIsNamed) {
    write(directory_ / "README");
    write(directory_ / "day.tar", "<html>404</html>");
    const SourceListing listing = list();
    EXPECT_THAT(listing.cut, ElementsAre(HasSubstr("day.tar: is no archive")));
    EXPECT_EQ(listing.nameless, 1U);
}

// 2026-11-29: if an archive was cut, the members after the cut were neither gridded nor reported.
TEST_F(Source, ATarThatIsCutIsNamed) {
    write_tar("day.tar",
              {{"KTLX20130520_203000", archive::bytes_of(std::string(9000, 'a'))},
               {"KTLX20130520_204000", archive::bytes_of(std::string(9000, 'b'))}},
              12'000);
    const SourceListing listing = list();
    EXPECT_EQ(listing.nameless, 0U);
    ASSERT_EQ(listing.cut.size(), 2U);
    EXPECT_THAT(listing.cut[0], HasSubstr("day.tar!KTLX20130520_204000: is cut"));
    EXPECT_THAT(listing.cut[1], HasSubstr("day.tar: the archive cannot be read behind"));
    ASSERT_EQ(listing.days.size(), 1U);
    const BroughtFiles brought = bring_first_day();
    EXPECT_THAT(names_of(brought), ElementsAre("KTLX20130520_203000"));
    ASSERT_EQ(brought.left_out.size(), 2U);
    EXPECT_EQ(brought.left_out[0].path, "day.tar!KTLX20130520_204000");
    EXPECT_EQ(brought.left_out[1].path, "day.tar");
}

// 2026-11-29: a member that could not be read was not reported.
TEST_F(Source, AMemberThatCannotBeReadIsNamed) {
    using enum archive::Put::What;
    write_tar("day.tar",
              {{"day/KTLX20130520_203000", archive::bytes_of("a")},
               {.name = "day/KTLX20130520_204000", .what = symlink, .target = "elsewhere"},
               {.name = "day/latest", .what = symlink, .target = "KTLX20130520_203000"}});
    expect_one_left_out("day.tar!day/KTLX20130520_204000",
                        "day.tar!day/KTLX20130520_204000: is a link");
}

// 2026-11-29: if an archive was cut, the members after the cut were reported only if the cut was
// within a volume.
TEST_F(Source, ATarThatIsCutBehindItsVolumesIsNamed) {
    write_tar("day.tar",
              {{"KTLX20130520_203000", archive::bytes_of("a")},
               {"README", archive::bytes_of(std::string(9000, 'b'))},
               {"KTLX20130520_204000", archive::bytes_of("c")}},
              5000);
    expect_one_left_out("day.tar", "behind README");
}

// 2026-11-29: if two archives had the same volume, the copy that was read last was taken, even if
// it was incomplete.
TEST_F(Source, FilesOfOneNameInTwoArchivesAreBothBrought) {
    for (const char* name : {"a.tar", "b.tar"})
        write_tar(name, {{"KTLX20130520_203000", archive::bytes_of(name)}});
    const BroughtFiles brought = bring_first_day();
    ASSERT_THAT(names_of(brought), ElementsAre("KTLX20130520_203000", "KTLX20130520_203000"));
    EXPECT_NE(read_file(brought.files[0]).value(), read_file(brought.files[1]).value());
}

TEST_F(Source, ABucketIsFetchedToTheScratchDirectory) {
    fetch::MockBucket bucket;
    bucket.set_page(1);
    bucket.put("2017/01/01/KTLX/KTLX20170101_030027_V06", std::string(5000, 'a'));
    bucket.put("2017/01/01/KTLX/KTLX20170101_030027_V06_MDM", std::string(50, 'm'));
    bucket.put("2017/01/01/KTLX/KTLX20170101_030627_V06", std::string(6000, 'b'));
    bucket.put("2017/01/01/KFDR/KFDR20170101_030127_V06", std::string(7000, 'c'));
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     {fetch::MockBucket::Fault::unavailable});
    recipe_.source = bucket.address();
    recipe_.from = at("2017-01-01T00:00Z");
    recipe_.to = at("2017-01-01T12:00Z");
    const StationDay what{std::chrono::floor<std::chrono::days>(recipe_.from), "KTLX", {}, 0, 0};
    const auto brought = bring(what);
    ASSERT_TRUE(brought) << brought.error().message;
    EXPECT_THAT(names_of(*brought),
                ElementsAre("KTLX20170101_030027_V06", "KTLX20170101_030627_V06"));
    EXPECT_EQ(fs::file_size(brought->files[0]), 5000U);

    // A failed transfer may succeed at another try.
    fs::remove(brought->files[0]);
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     std::vector(6, fetch::MockBucket::Fault::unavailable));
    const auto failed = bring(what);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::io);
    EXPECT_THAT(failed.error().message, HasSubstr("1 of 2 files could not be fetched"));

    // A file that the bucket lists but refuses is left out, because no other try could succeed.
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     {fetch::MockBucket::Fault::missing});
    const auto without = bring(what);
    ASSERT_TRUE(without) << without.error().message;
    EXPECT_THAT(names_of(*without), ElementsAre("KTLX20170101_030627_V06"));
    ASSERT_EQ(without->left_out.size(), 1U);
    EXPECT_EQ(without->left_out[0].path, "KTLX20170101_030027_V06");
    EXPECT_THAT(without->left_out[0].reason, HasSubstr("404"));
}

}  // namespace
}  // namespace stormcellar::batch
