// The program itself, as a user runs it: what it prints and how it ends.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

class InfoTest : public ::testing::Test {
  protected:
    static ProgramResult info(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "info");
        return testing::run_program(STORMCELLAR_PROGRAM, arguments);
    }
    std::string write(const std::string& name, const std::string& text) {
        const auto path = directory_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    // One line on stderr that has all these parts, nothing on stdout, exit 1.
    static void expect_refused(const ProgramResult& ran, const std::vector<std::string>& parts) {
        EXPECT_EQ(ran.status, 1);
        EXPECT_EQ(ran.out, "");
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        for (const std::string& part : parts)
            EXPECT_NE(ran.err.find(part), std::string::npos) << part << " in " << ran.err;
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(InfoTest, NamesTheFileAndTheReasonWhenItCannotBeRead) {
    expect_refused(info({write("empty", "")}), {"empty", "the file is empty"});
    expect_refused(info({write("text", std::string(100000, 'x'))}),
                   {"text", "not a Level II file"});
    expect_refused(info({write("zeros", std::string(100000, '\0'))}),
                   {"zeros", "not a Level II file"});
    expect_refused(info({directory_.path()}), {directory_.path().string()});
    expect_refused(info({directory_ / "missing"}), {"missing"});
    expect_refused(info({"/dev/null"}), {"/dev/null"});
}

TEST_F(InfoTest, EscapesOddNames) {
    expect_refused(info({write("a\nb\x1b[31m'c\xff", "")}), {"a\\x0ab\\x1b[31m'c\\xff"});
}

TEST_F(InfoTest, BadUsageIsExit2) {
    EXPECT_EQ(info({}).status, 2);
    EXPECT_EQ(info({"--no-such-option", "x"}).status, 2);
    EXPECT_EQ(info({"a", "--threads", "0"}).status, 2);
}

TEST_F(InfoTest, JsonIsOneDocumentWithTheFactsAndNoProblems) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran =
        info({*testing::data_directory() / "volumes" / "KLOT20220317_000842_V06", "--json"});
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.err, "");
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json.at("file"), "KLOT20220317_000842_V06");
    EXPECT_EQ(json.at("size"), 2661841);
    EXPECT_EQ(json.at("n_radials"), 6480);
    EXPECT_EQ(json.at("complete"), true);
    EXPECT_EQ(json.at("problems"), nlohmann::json::array());
}

TEST_F(InfoTest, ADamagedVolumeIsDoneWithItsProblemsListed) {
    STORMCELLAR_NEED_DATA();
    const auto file = *testing::data_directory() / "volumes" / "KTLX19910720_160529.gz";
    const ProgramResult ran = info({file, "--json"});
    EXPECT_EQ(ran.status, 0);
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json.at("site"), "KTLX") << "from the file's name";
    EXPECT_EQ(json.at("complete"), false);
    ASSERT_FALSE(json.at("problems").empty());
    const auto& problem = json.at("problems").front();
    EXPECT_EQ(problem.at("severity"), "error");
    EXPECT_EQ(problem.at("code"), "damaged_messages");
    EXPECT_EQ(problem.at("offset"), 1507840);
    const ProgramResult table = info({file});
    EXPECT_EQ(table.status, 0);
    EXPECT_NE(table.out.find("partial"), std::string::npos);
    EXPECT_NE(table.out.find("1367 bytes dropped (at 1507840)"), std::string::npos) << table.out;
}

TEST_F(InfoTest, TheTableHasALineForEachSweep) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran =
        info({*testing::data_directory() / "volumes" / "KBBX20060113_170337.gz"});
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.out.find("68 sweeps, 13623 radials, 4 volumes"), std::string::npos) << ran.out;
    // Radials are missing in every sweep of this file: eight are named, the others counted.
    const int facts = 8, blank_and_heading = 2, further_volumes = 3, blank_and_problems = 10;
    EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), 0x0A),
              facts + blank_and_heading + further_volumes + 68 + blank_and_problems)
        << ran.out;
}

}  // namespace
}  // namespace stormcellar::cli
