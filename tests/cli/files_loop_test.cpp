// Runs `stormcellar loop FILE...` as a user does.
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"
#include "tests/cli/files_and_service.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

class FilesLoop : public FilesAndService {
  protected:
    void SetUp() override {
        FilesAndService::SetUp();
        ::setenv("XDG_CACHE_HOME", (directory_ / "home").c_str(), 1);
    }
    [[nodiscard]] static std::string sequence(const std::string& name = "") {
        return (testing::real_file("sequence-kbgm") / name).string();
    }
    [[nodiscard]] testing::ProgramResult run(const Words& sources, const Words& more = {}) const {
        const Words small = words(
            "--product composite --width 400 --height 300 --spacing-km 4 --extent-km 400,400 "
            "--json -o " +
            out());
        return cli::run(with(with({"loop"}, sources), small, more));
    }
    [[nodiscard]] nlohmann::json json_of(const Words& sources, const Words& more = {}) const {
        return testing::json_of(run(sources, more));
    }
    [[nodiscard]] std::string out() const { return directory_ / "a.webp"; }
    [[nodiscard]] std::vector<std::byte> loop() const { return *read_file(out()); }
};

TEST_F(FilesLoop, ADirectoryItsFilesAndTheirArchiveGiveTheSameLoop) {
    const auto made = json_of({sequence()});
    EXPECT_EQ(made["domain"], "KBGM");
    EXPECT_EQ(made["frames"], 5);
    EXPECT_EQ(made["grids_made"], 5);
    EXPECT_EQ(made["from"], "2005-08-22T02:44:14Z");
    EXPECT_EQ(made["to"], "2005-08-22T03:08:30Z");
    const auto by_directory = loop();

    Words files;
    for (const auto& entry : fs::directory_iterator(sequence())) {
        files.push_back(entry.path().string());
    }
    // The grids of these files exist, because an earlier run made them from the directory.
    EXPECT_EQ(json_of(files)["grids_found"], 5);
    EXPECT_EQ(loop(), by_directory);

    const fs::path tar = directory_ / "all.tar";
    ASSERT_EQ(std::system(("tar cf " + tar.string() + " -C " + sequence() + " .").c_str()), 0);
    EXPECT_EQ(json_of({tar.string()})["grids_made"], 5);
    EXPECT_EQ(loop(), by_directory);
}

TEST_F(FilesLoop, OnlyTheFilesThatAreNamedAreShown) {
    const std::string second = sequence("KBGM20050822_025001.gz");
    const std::string third = sequence("KBGM20050822_025549.gz");
    EXPECT_EQ(json_of({sequence()})["frames"], 5);
    const auto two = json_of({third, second});
    EXPECT_EQ(two["frames"], 2);
    EXPECT_EQ(two["grids_found"], 2);
    EXPECT_EQ(two["from"], "2005-08-22T02:50:01Z");
    // The first of the three volumes begins before 03:00 and ends after it.
    EXPECT_EQ(json_of({sequence()}, {"--from", "2005-08-22T03:00"})["frames"], 3);
}

TEST_F(FilesLoop, FilesOfSeveralSitesGiveAMosaic) {
    const auto made =
        json_of({testing::real_file("mosaic-northeast").string()}, {"--center", "42,-75"});
    EXPECT_EQ(made["domain"], "mosaic-of-7");
    EXPECT_EQ(made["volumes"], 7);
    EXPECT_GE(made["frames"], 4);
}

TEST_F(FilesLoop, WithoutACacheToKeepNothingStays) {
    EXPECT_EQ(json_of({sequence("KBGM20050822_025001.gz")}, {"--no-keep-cache"})["frames"], 1);
    EXPECT_TRUE(fs::is_empty(directory_ / "home" / "stormcellar" / "loops"));
}

TEST_F(FilesLoop, ACacheThatIsNamedHoldsGridsAndCatalog) {
    const std::string cache = directory_ / "cache";
    EXPECT_EQ(json_of({sequence()}, {"--cache", cache})["grids_made"], 5);
    EXPECT_FALSE(fs::exists(directory_ / "home"));
    EXPECT_EQ(json_of({sequence()}, {"--cache", cache})["grids_found"], 5);
}

// 2026-11-29: members without a volume were left out without a message.
TEST_F(FilesLoop, MembersThatHoldNoVolumeAreNamedEachTime) {
    const fs::path day = directory_ / "day", tar = directory_ / "day.tar";
    fs::create_directory(day);
    fs::copy_file(sequence("KBGM20050822_025001.gz"), day / "KBGM20050822_025001.gz");
    std::ofstream(day / "KBGM20050822_025549.gz") << "<html>404</html>";
    std::ofstream(day / "notes") << "";
    ASSERT_EQ(std::system(("tar cf " + tar.string() + " -C " + day.string() + " .").c_str()), 0);
    for (int turn = 1; turn <= 2; ++turn) {
        const auto result = run({tar.string()});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, HasSubstr("left out: " + tar.string() + "!./KBGM20050822_025549"));
        EXPECT_THAT(result.err, HasSubstr(tar.string() + "!./notes: "));
        const auto made = nlohmann::json::parse(result.out);
        EXPECT_EQ(made["frames"], 1);
        EXPECT_EQ(made["left_out"].size(), 2U) << made["left_out"];
    }
}

TEST_F(FilesLoop, SaysWhatItCannotUse) {
    const auto piped = run({"-"});
    EXPECT_EQ(piped.status, 2);
    EXPECT_THAT(piped.err, HasSubstr("standard input"));
    EXPECT_THAT(run({sequence()}, {"--catalog", "x"}).err, HasSubstr("name only one"));
    EXPECT_THAT(run({sequence()}, {"--follow"}).err, HasSubstr("--follow is for a domain"));
    EXPECT_THAT(run({sequence("none.gz")}).err, HasSubstr("none.gz"));
    fs::create_directory(directory_ / "texts");
    std::ofstream(directory_ / "texts" / "KBGM20050822_025001.gz") << "no volume at all";
    const auto texts = run({(directory_ / "texts").string()});
    EXPECT_EQ(texts.status, 1);
    EXPECT_FALSE(fs::exists(out()));
}

}  // namespace
}  // namespace stormcellar::cli
