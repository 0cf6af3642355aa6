// Tests archives, directories and standard input wherever a command takes raw files.
#include "cli/shared/input_files.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"
#include "tests/archive/archive_maker.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ProgramResult;

const char* const two_of_them[] = {"KBGM20100911_012056_V03.gz", "KENX20100911_011108_V03.gz"};

class InputFilesTest : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    [[nodiscard]] static std::string real(const std::string& name) {
        return (testing::real_file("mosaic-northeast") / name).string();
    }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (directory_ / name).string();
    }
    std::string put_archive(const std::string& name, archive::Kind kind) {
        std::vector<archive::Put> puts = {{"README.txt", archive::bytes_of("two volumes")}};
        for (const char* file : two_of_them)
            puts.push_back({std::string("order/") + file, read_file(real(file)).value()});
        EXPECT_TRUE(
            write_file_atomically(real_file_system(), at(name), archive::make_archive(kind, puts)));
        return at(name);
    }
    nlohmann::json grid(const Words& files) {
        Words arguments = {"grid", "--spacing-km", "8",  "--levels-km",
                           "1,3",  "--json",       "-o", at("out.nc")};
        const ProgramResult ran = run(with(arguments, files));
        EXPECT_EQ(ran.status, 0) << ran.err;
        errors_ = ran.err;
        return ran.status == 0 ? nlohmann::json::parse(ran.out) : nlohmann::json::object();
    }
    static ProgramResult shell(const std::string& line) {
        return testing::run_program("/bin/sh", {"-c", line});
    }

    testing::TemporaryDirectory directory_;
    std::string errors_;
};

TEST_F(InputFilesTest, MembersOfAnArchiveGiveTheSameMosaicAsTheFiles) {
    const auto plain = grid({real(two_of_them[0]), real(two_of_them[1])});
    for (const archive::Kind kind :
         {archive::Kind::tar, archive::Kind::tar_gz, archive::Kind::zip}) {
        const auto packed = grid({put_archive("order.bin", kind)});
        EXPECT_EQ(packed["cells"], plain["cells"]);
        EXPECT_EQ(packed["stations"], plain["stations"]);
        EXPECT_THAT(errors_, HasSubstr("left out: ")) << "README.txt is not a volume";
    }
}

TEST_F(InputFilesTest, ADirectoryStandsForItsFiles) {
    fs::create_directories(directory_ / "order" / "inner");
    fs::copy_file(real(two_of_them[0]), directory_ / "order" / "inner" / two_of_them[0]);
    fs::copy_file(real(two_of_them[1]), directory_ / "order" / two_of_them[1]);
    std::ofstream(directory_ / "order" / ".hidden") << "no";
    const auto plain = grid({real(two_of_them[0]), real(two_of_them[1])});
    EXPECT_EQ(grid({at("order")})["cells"], plain["cells"]);
}

TEST_F(InputFilesTest, OneMemberIsNamedBehindItsArchive) {
    const std::string path = put_archive("order.tar", archive::Kind::tar);
    EXPECT_EQ(json_of(run({"info", path + "!order/" + two_of_them[1], "--json"}))["site"], "KENX");
    const ProgramResult none = run({"info", path + "!order/other"});
    EXPECT_EQ(none.status, 1);
    EXPECT_THAT(none.err, HasSubstr("is not in the archive"));
}

// 2026-11-28: the message said that the archive has no such member.
TEST_F(InputFilesTest, OfAMemberThatCannotBeReadIsSaidWhy) {
    const std::string path = put_archive("order.tar", archive::Kind::tar);
    fs::resize_file(path, fs::file_size(path) - 100'000);
    const ProgramResult cut = run({"info", path + "!order/" + two_of_them[1]});
    EXPECT_EQ(cut.status, 1);
    EXPECT_THAT(cut.err, ::testing::Not(HasSubstr("does not have this member")));
    EXPECT_THAT(cut.err, HasSubstr("cut"));
}

TEST_F(InputFilesTest, InfoTellsOfEachVolume) {
    const std::string path = put_archive("order.tar.gz", archive::Kind::tar_gz);
    const ProgramResult all = run({"info", path, "--json"});
    const auto documents = json_of(all);
    ASSERT_EQ(documents.size(), 2U);
    EXPECT_EQ(documents[0]["site"], "KBGM");
    EXPECT_EQ(documents[1]["site"], "KENX");
    EXPECT_THAT(all.err, HasSubstr("README.txt"));
    const ProgramResult to = run({"info", path, "--to", at("x.nc")});
    EXPECT_EQ(to.status, 2);
    EXPECT_THAT(to.err, HasSubstr("name one of them"));
}

TEST_F(InputFilesTest, StandardInputIsAFileOrAnArchive) {
    const std::string program = STORMCELLAR_PROGRAM;
    const std::string path = put_archive("order.zip", archive::Kind::zip);
    EXPECT_EQ(json_of(shell(program + " info - --json < " + real(two_of_them[0])))["site"], "KBGM");
    EXPECT_EQ(json_of(shell("cat " + path + " | " + program + " info - --json")).size(), 2U);
    EXPECT_EQ(json_of(shell("mkfifo " + at("pipe") + "; cat " + path + " > " + at("pipe") +
                            " & exec " + program + " info " + at("pipe") + " --json"))
                  .size(),
              2U);
    EXPECT_EQ(shell(program + " grid - - -o " + at("a.nc") + " < " + path).status, 2);
}

TEST_F(InputFilesTest, OfACutArchiveWhatIsWholeIsTaken) {
    const std::string path = put_archive("order.tar", archive::Kind::tar);
    fs::resize_file(path, fs::file_size(path) - 100'000);
    const auto made = grid({path});
    EXPECT_EQ(made["stations"], Words{"KBGM"});
    EXPECT_THAT(errors_, HasSubstr("cut or damaged"));
}

TEST_F(InputFilesTest, AnArchiveIsReplayedMemberByMember) {
    const std::string path = put_archive("order.tar.gz", archive::Kind::tar_gz);
    fs::create_directory(directory_ / "drop");
    ASSERT_EQ(run({"replay", path, at("drop"), "--interval", "0"}).status, 0);
    for (const char* file : two_of_them) {
        EXPECT_TRUE(read_file(at(std::string("drop/order/") + file)).value() ==
                    read_file(real(file)).value());
    }
    fs::create_directory(directory_ / "chunks");
    // Volumes that cannot be sent in chunks are named; all other volumes are replayed.
    const std::string in_records = testing::real_file("volumes/KLBB20160601_150025_V06").string();
    const ProgramResult chunks =
        run({"replay", path, in_records, at("chunks"), "--interval", "0", "--as", "chunks"});
    EXPECT_EQ(chunks.status, 0) << chunks.err;
    EXPECT_THAT(chunks.err,
                HasSubstr("README.txt: holds no LDM records, so it cannot come in chunks"));
    EXPECT_TRUE(fs::exists(directory_ / "chunks" / "KLBB"));
}

TEST_F(InputFilesTest, WhatHoldsNothingSaysSo) {
    fs::create_directory(directory_ / "empty");
    const ProgramResult empty = run({"info", at("empty")});
    EXPECT_EQ(empty.status, 1);
    EXPECT_THAT(empty.err, HasSubstr("holds no file"));
    EXPECT_EQ(run({"info", at("none")}).status, 1);
    ASSERT_TRUE(write_file_atomically(
        real_file_system(), at("text.tar"),
        archive::make_archive(archive::Kind::tar, {{"a.txt", archive::bytes_of("text")}})));
    EXPECT_EQ(run({"info", at("text.tar")}).status, 1);
}

}  // namespace
}  // namespace stormcellar::cli
