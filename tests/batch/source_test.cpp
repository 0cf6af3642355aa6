// Tests which files an archive has, and how they come to a task.
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

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

void write(const fs::path& path, const std::string& text = "x") {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

std::vector<std::string> names_of(const BroughtFiles& brought) {
    std::vector<std::string> names;
    for (const fs::path& path : brought.files)
        names.push_back(path.filename().native());
    return names;
}

TEST(Source, AVolumeIsKnownByItsName) {
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

TEST(Source, ListsADirectoryByDayAndStation) {
    const testing::TemporaryDirectory directory;
    write(directory / "b/KTLX20130520_200356", "12345");
    write(directory / "a/KTLX20130520_235959", "123");
    write(directory / "a/KTLX20130521_000500");
    write(directory / "a/KFDR20130521_000400");
    write(directory / "a/KFDR20130523_000400");  // after the range
    write(directory / "a/.KFDR20130521_000900");
    write(directory / "a/KFDR20130521_000900.part");
    write(directory / "a/readme");
    // 2026-11-28: a plan wrote this name with another letter, and its task failed for good.
    write(directory / "d\xEFx/KTLX20130521_001500");
    const auto listing = list_source(directory.path().native(), at("2013-05-20"), at("2013-05-22"));
    ASSERT_TRUE(listing);
    ASSERT_EQ(listing->days.size(), 3U);
    EXPECT_EQ(listing->days[0].station, "KTLX");
    EXPECT_THAT(listing->days[0].in, ElementsAre("a", "b"));
    EXPECT_EQ(listing->days[0].files, 2U);
    EXPECT_EQ(listing->days[0].bytes, 8U);
    EXPECT_EQ(listing->days[1].station, "KFDR");
    EXPECT_EQ(listing->days[2].station, "KTLX");
    EXPECT_EQ(listing->nameless, 2U);
    EXPECT_THAT(listing->first_nameless, AnyOf("a/readme", "d\\xEFx", "d\\xefx"));
    EXPECT_EQ(listing->links, 0U);
    EXPECT_EQ(list_source((directory / "none").native(), {}, {}).error().code,
              ErrorCode::not_found);
}

TEST(Source, BringsTheFilesOfARangeInTheirOrder) {
    const testing::TemporaryDirectory directory, scratch;
    for (const char* name : {"KTLX20130520_200356", "KTLX20130520_210000", "KTLX20130520_220000",
                             "KFDR20130520_210000"})
        write(directory / "day" / name);
    write(directory / "again/KTLX20130520_203000");
    Recipe recipe;
    recipe.source = directory.path().native();
    recipe.from = at("2013-05-20T20:30Z");
    recipe.to = at("2013-05-20T21:00Z");
    const StationDay what{
        std::chrono::floor<std::chrono::days>(recipe.from), "KTLX", {"again", "day"}, 2, 2};
    const std::atomic<bool> stop{false};
    const auto own = bring(recipe, what, scratch.path(), stop);
    ASSERT_TRUE(own);
    EXPECT_THAT(names_of(*own), ElementsAre("KTLX20130520_203000", "KTLX20130520_210000"));
    // Frames need the volumes around the range, too.
    recipe.domain = pipeline::small_domain();
    recipe.to = at("2013-05-20T21:40Z");
    EXPECT_THAT(names_of(*bring(recipe, what, scratch.path(), stop)),
                ElementsAre("KTLX20130520_203000", "KTLX20130520_210000", "KTLX20130520_220000"));
}

// 2026-11-29: links were passed over without a word.
TEST(Source, LinksAreNotFollowedAndCounted) {
    const testing::TemporaryDirectory directory, other;
    write(directory / "KTLX20130520_200356");
    write(other / "KTLX20130520_210000");
    fs::create_directory_symlink(other.path(), directory / "2012");
    fs::create_symlink(other / "KTLX20130520_210000", directory / "KTLX20130520_210000");
    const auto listing = list_source(directory.path().native(), at("2013-05-20"), at("2013-05-22"));
    ASSERT_TRUE(listing);
    EXPECT_EQ(listing->days.at(0).files, 1U);
    EXPECT_EQ(listing->links, 2U);
    EXPECT_EQ(listing->first_link.parent_path(), directory.path());
}

// 2026-11-29: the plan said that its name has no station and time.
TEST(Source, WhatIsNamedAsATarAndIsNoneIsNamed) {
    const testing::TemporaryDirectory directory;
    write(directory / "README");
    write(directory / "day.tar", "<html>404</html>");
    const auto listing = list_source(directory.path().native(), at("2013-05-20"), at("2013-05-22"));
    ASSERT_TRUE(listing);
    EXPECT_THAT(listing->cut, ElementsAre(HasSubstr("day.tar: is no archive")));
    EXPECT_EQ(listing->nameless, 1U);
}

// 2026-11-29: what lay behind the cut was neither made nor named.
TEST(Source, ATarThatIsCutIsNamed) {
    const testing::TemporaryDirectory directory, scratch;
    auto tar = archive::make_archive(
        archive::Kind::tar, {{"KTLX20130520_203000", archive::bytes_of(std::string(9000, 'a'))},
                             {"KTLX20130520_204000", archive::bytes_of(std::string(9000, 'b'))}});
    tar.resize(12'000);
    write(directory / "day.tar", {reinterpret_cast<const char*>(tar.data()), tar.size()});
    const auto listing = list_source(directory.path().native(), at("2013-05-20"), at("2013-05-22"));
    ASSERT_TRUE(listing);
    EXPECT_EQ(listing->nameless, 0U);
    ASSERT_EQ(listing->cut.size(), 2U);
    EXPECT_THAT(listing->cut[0], HasSubstr("day.tar!KTLX20130520_204000: is cut"));
    EXPECT_THAT(listing->cut[1], HasSubstr("day.tar: the archive cannot be read behind"));
    ASSERT_EQ(listing->days.size(), 1U);
    Recipe recipe;
    recipe.source = directory.path().native();
    recipe.from = at("2013-05-20T20:00Z");
    recipe.to = at("2013-05-20T21:00Z");
    const std::atomic<bool> stop{false};
    const auto brought = bring(recipe, listing->days[0], scratch.path(), stop);
    ASSERT_TRUE(brought) << brought.error().message;
    EXPECT_THAT(names_of(*brought), ElementsAre("KTLX20130520_203000"));
    ASSERT_EQ(brought->left_out.size(), 2U);
    EXPECT_EQ(brought->left_out[0].path, "day.tar!KTLX20130520_204000");
    EXPECT_EQ(brought->left_out[1].path, "day.tar");
}

// 2026-11-29: a member that could not be read vanished without a word.
TEST(Source, AMemberThatCannotBeReadIsNamed) {
    const testing::TemporaryDirectory directory, scratch;
    const auto tar = archive::make_archive(archive::Kind::tar,
                                           {{"day/KTLX20130520_203000", archive::bytes_of("a")},
                                            {.name = "day/KTLX20130520_204000",
                                             .what = archive::Put::What::symlink,
                                             .target = "elsewhere"},
                                            {.name = "day/latest",
                                             .what = archive::Put::What::symlink,
                                             .target = "KTLX20130520_203000"}});
    write(directory / "day.tar", {reinterpret_cast<const char*>(tar.data()), tar.size()});
    Recipe recipe;
    recipe.source = directory.path().native();
    recipe.from = at("2013-05-20T20:00Z");
    recipe.to = at("2013-05-20T21:00Z");
    const auto listing = list_source(recipe.source, recipe.from, recipe.to);
    ASSERT_TRUE(listing);
    ASSERT_EQ(listing->cut.size(), 1U);
    EXPECT_THAT(listing->cut[0], HasSubstr("day.tar!day/KTLX20130520_204000: is a link"));
    const std::atomic<bool> stop{false};
    const auto brought = bring(recipe, listing->days.at(0), scratch.path(), stop);
    ASSERT_TRUE(brought) << brought.error().message;
    ASSERT_EQ(brought->left_out.size(), 1U);
    EXPECT_EQ(brought->left_out[0].path, "day.tar!day/KTLX20130520_204000");
}

// 2026-11-29: what lay behind the cut was not named if no volume was cut.
TEST(Source, ATarThatIsCutBehindItsVolumesIsNamed) {
    const testing::TemporaryDirectory directory, scratch;
    auto tar = archive::make_archive(archive::Kind::tar,
                                     {{"KTLX20130520_203000", archive::bytes_of("a")},
                                      {"README", archive::bytes_of(std::string(9000, 'b'))},
                                      {"KTLX20130520_204000", archive::bytes_of("c")}});
    tar.resize(5000);
    write(directory / "day.tar", {reinterpret_cast<const char*>(tar.data()), tar.size()});
    Recipe recipe;
    recipe.source = directory.path().native();
    recipe.from = at("2013-05-20T20:00Z");
    recipe.to = at("2013-05-20T21:00Z");
    const auto listing = list_source(recipe.source, recipe.from, recipe.to);
    ASSERT_TRUE(listing);
    ASSERT_EQ(listing->cut.size(), 1U);
    EXPECT_THAT(listing->cut[0], HasSubstr("behind README"));
    const std::atomic<bool> stop{false};
    const auto brought = bring(recipe, listing->days.at(0), scratch.path(), stop);
    ASSERT_TRUE(brought) << brought.error().message;
    ASSERT_EQ(brought->left_out.size(), 1U);
    EXPECT_EQ(brought->left_out[0].path, "day.tar");
}

// 2026-11-29: of two archives with a volume, the one that was read last counted, whole or not.
TEST(Source, FilesOfOneNameInTwoArchivesAreBothBrought) {
    const testing::TemporaryDirectory directory, scratch;
    for (const char* name : {"a.tar", "b.tar"}) {
        const auto tar = archive::make_archive(archive::Kind::tar,
                                               {{"KTLX20130520_203000", archive::bytes_of(name)}});
        write(directory / name, {reinterpret_cast<const char*>(tar.data()), tar.size()});
    }
    Recipe recipe;
    recipe.source = directory.path().native();
    recipe.from = at("2013-05-20T20:00Z");
    recipe.to = at("2013-05-20T21:00Z");
    const auto listing = list_source(recipe.source, recipe.from, recipe.to);
    ASSERT_TRUE(listing);
    const std::atomic<bool> stop{false};
    const auto brought = bring(recipe, listing->days.at(0), scratch.path(), stop);
    ASSERT_TRUE(brought) << brought.error().message;
    ASSERT_THAT(names_of(*brought), ElementsAre("KTLX20130520_203000", "KTLX20130520_203000"));
    EXPECT_NE(read_file(brought->files[0]).value(), read_file(brought->files[1]).value());
}

TEST(Source, ABucketIsFetchedToTheScratchDirectory) {
    fetch::MockBucket bucket;
    bucket.set_page(1);
    bucket.put("2017/01/01/KTLX/KTLX20170101_030027_V06", std::string(5000, 'a'));
    bucket.put("2017/01/01/KTLX/KTLX20170101_030027_V06_MDM", std::string(50, 'm'));
    bucket.put("2017/01/01/KTLX/KTLX20170101_030627_V06", std::string(6000, 'b'));
    bucket.put("2017/01/01/KFDR/KFDR20170101_030127_V06", std::string(7000, 'c'));
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     {fetch::MockBucket::Fault::unavailable});
    const testing::TemporaryDirectory scratch;
    Recipe recipe;
    recipe.source = bucket.address();
    recipe.from = at("2017-01-01T00:00Z");
    recipe.to = at("2017-01-01T12:00Z");
    const StationDay what{std::chrono::floor<std::chrono::days>(recipe.from), "KTLX", {}, 0, 0};
    const std::atomic<bool> stop{false};
    const auto brought = bring(recipe, what, scratch.path(), stop);
    ASSERT_TRUE(brought) << brought.error().message;
    EXPECT_THAT(names_of(*brought),
                ElementsAre("KTLX20170101_030027_V06", "KTLX20170101_030627_V06"));
    EXPECT_EQ(fs::file_size(brought->files[0]), 5000U);

    // A file that cannot be had now may come with another try.
    fs::remove(brought->files[0]);
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     std::vector(6, fetch::MockBucket::Fault::unavailable));
    const auto failed = bring(recipe, what, scratch.path(), stop);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::io);
    EXPECT_THAT(failed.error().message, HasSubstr("1 of 2 files could not be fetched"));

    // A file that the bucket lists but does not give never comes.
    bucket.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06",
                     {fetch::MockBucket::Fault::missing});
    const auto without = bring(recipe, what, scratch.path(), stop);
    ASSERT_TRUE(without) << without.error().message;
    EXPECT_THAT(names_of(*without), ElementsAre("KTLX20170101_030627_V06"));
    ASSERT_EQ(without->left_out.size(), 1U);
    EXPECT_EQ(without->left_out[0].path, "KTLX20170101_030027_V06");
    EXPECT_THAT(without->left_out[0].reason, HasSubstr("404"));
}

}  // namespace
}  // namespace stormcellar::batch
