// Runs `stormcellar info` as a user does, and tests its output and exit status.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

class InfoTest : public ::testing::Test {
  protected:
    static ProgramResult info(const Words& arguments) { return run(with({"info"}, arguments)); }
    std::string write(const std::string& name, const std::string& text) {
        const auto path = directory_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    // Expects one line on stderr with all of these parts, nothing on stdout, and exit status 1.
    static void expect_refused(const ProgramResult& ran, const Words& parts) {
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
        info({testing::real_file("volumes/KLOT20220317_000842_V06"), "--json"});
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.err, "");
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json.at("file"), "KLOT20220317_000842_V06");
    EXPECT_EQ(json.at("size"), 2661841);
    EXPECT_EQ(json.at("n_radials"), 6480);
    EXPECT_EQ(json.at("complete"), true);
    EXPECT_EQ(json.at("problems"), nlohmann::json::array());
}

// KABR sees the ground on a clear evening; a file of four volumes gets four tables.
TEST_F(InfoTest, SaysWhatTheEchoIs) {
    STORMCELLAR_NEED_DATA();
    const std::string kabr = testing::real_file("volumes/KABR20050101_000745.gz");
    const ProgramResult table = info({kabr, "--echo"});
    ASSERT_EQ(table.status, 0) << table.err;
    EXPECT_NE(table.out.find("  ground clutter                36."), std::string::npos)
        << table.out;
    EXPECT_NE(table.out.find("no melting layer found: the volume has no dual polarization"),
              std::string::npos);
    const ProgramResult ran = info({kabr, "--echo", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto echo = nlohmann::json::parse(ran.out).at("echo");
    ASSERT_EQ(echo.size(), 1U);
    EXPECT_GT(echo[0].at("gates"), 10'000);
    double sum = 0;
    for (const auto& percent : echo[0].at("percent"))
        sum += percent.get<double>();
    EXPECT_NEAR(sum, 100, 1e-9);
    EXPECT_GT(echo[0].at("percent").at("ground_clutter"), 30);
    const ProgramResult four =
        info({testing::real_file("volumes/KBBX20060113_170337.gz"), "--echo", "--json"});
    const auto document = nlohmann::json::parse(four.out);
    EXPECT_EQ(document.at("echo").size(), document.at("volumes").size());
}

// The antenna of KLBB is 1029 m above sea level.
TEST_F(InfoTest, SaysWhereSnowMelts) {
    STORMCELLAR_NEED_DATA();
    const std::string klbb = testing::real_file("volumes/KLBB20160601_150025_V06");
    const ProgramResult table = info({klbb, "--echo"});
    ASSERT_EQ(table.status, 0) << table.err;
    EXPECT_NE(table.out.find("  melting layer from 3.3"), std::string::npos) << table.out;
    const ProgramResult ran = info({klbb, "--echo", "--json"});
    const auto layer = nlohmann::json::parse(ran.out).at("echo").at(0).at("melting_layer");
    EXPECT_NEAR(layer.at("top_m_above_antenna").get<double>(), 2850, 200);
    EXPECT_NEAR(layer.at("antenna_m").get<double>(), 1029, 1);
    EXPECT_GT(layer.at("top_error_m").get<double>(), 50);
}

TEST_F(InfoTest, ADamagedVolumeIsDoneWithItsProblemsListed) {
    STORMCELLAR_NEED_DATA();
    const auto file = testing::real_file("volumes/KTLX19910720_160529.gz");
    const ProgramResult ran = info({file, "--json"});
    EXPECT_EQ(ran.status, 0);
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json.at("site"), "KTLX") << "the file's name gives the site";
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

TEST_F(InfoTest, WritesTheVolumeAndStillPrintsItsFacts) {
    STORMCELLAR_NEED_DATA();
    const auto file = testing::real_file("volumes/KIWX20160429_194300_V06.gz");
    const std::string to = directory_ / "x.nc";
    const ProgramResult plain = info({file});
    const ProgramResult ran = info({file, "--to", to});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_EQ(ran.out, plain.out + "\n" + to + ": written as CfRadial\n");
    const auto first = *read_file(to);
    auto json = nlohmann::json::parse(info({file, "--json", "--to", to}).out);
    EXPECT_EQ(json.at("written"), to);
    json.erase("written");
    EXPECT_EQ(json, nlohmann::json::parse(info({file, "--json"}).out));
    EXPECT_EQ(*read_file(to), first) << "the file was replaced by the same bytes";
}

TEST_F(InfoTest, TheEndingOrTheOptionChoosesTheFormat) {
    STORMCELLAR_NEED_DATA();
    const auto file = testing::real_file("volumes/KIWX20160429_194300_V06.gz");
    const auto written_as = [&](const std::string& name, std::vector<std::string> options) {
        const std::string to = directory_ / name;
        options.insert(options.begin(), {file, "--to", to});
        const ProgramResult ran = info(options);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.out.substr(ran.out.find(": written as ") + 13);
    };
    EXPECT_EQ(written_as("x.h5", {}), "ODIM_H5\n");
    EXPECT_EQ(written_as("x.uf", {}), "UF\n");
    EXPECT_EQ(written_as("x.nc", {"--format", "cfradial2"}), "CfRadial 2\n");
    const auto refused = [&](const std::vector<std::string>& arguments, std::string_view why) {
        const ProgramResult ran = info(arguments);
        EXPECT_EQ(ran.status, 2);
        EXPECT_NE(ran.err.find(why), std::string::npos) << ran.err;
    };
    refused({file, "--to", directory_ / "x.grib"},
            "must end in .nc or .nc4 or .h5 or .hdf or .hdf5 or .uf");
    refused({file, "--to", directory_ / "x.nc", "--format", "odim"},
            "the format is ODIM_H5: the name must end in .h5");
    refused({file, "--to", directory_ / "x.nc", "--format", "grib"}, "--format");
    refused({file, "--format", "odim"}, "--to");
}

TEST_F(InfoTest, WritesTheDealiasedVelocityIfAsked) {
    STORMCELLAR_NEED_DATA();
    const auto file = testing::real_file("volumes/KTLX19990503_235621.gz");
    const std::string to = directory_ / "x.nc";
    const auto has_field = [&](const Words& arguments,
                               std::string_view name = "VEL_dealiased_status") {
        const ProgramResult ran = run(with({"info", file, "--to", to}, arguments));
        EXPECT_EQ(ran.status, 0) << ran.err;
        const auto bytes = *read_file(to);
        const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        EXPECT_NE(text.find("VEL_status"), std::string::npos);
        return text.find(name) != std::string::npos;
    };
    EXPECT_FALSE(has_field({}));
    EXPECT_FALSE(has_field({"--dealias", "off"}));
    EXPECT_TRUE(has_field({"--dealias", "region"}));
    EXPECT_FALSE(has_field({"--dealias", "region"}, "AZSHEAR"));
    for (const char* field : {"AZSHEAR_status", "DIVERGENCE_status", "VEL_dealiased_status"})
        EXPECT_TRUE(has_field({"--moment", "AZSH,DIVG"}, field)) << field;
    const ProgramResult unknown = info({file, "--to", to, "--dealias", "strong"});
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("it must be off, auto, profile, region or anchored"),
              std::string::npos)
        << unknown.err;
    EXPECT_EQ(info({file, "--dealias", "region"}).status, 2) << "the option needs --to";
    const ProgramResult measured = info({file, "--to", to, "--moment", "AZSH,REF"});
    EXPECT_EQ(measured.status, 2);
    EXPECT_NE(measured.err.find("--moment REF: it names moments to derive"), std::string::npos);
}

TEST_F(InfoTest, AsksWhichOfSeveralVolumesToWrite) {
    STORMCELLAR_NEED_DATA();
    const auto file = testing::real_file("volumes/KBBX20060113_170337.gz");
    const std::string to = directory_ / "x.nc";
    for (const bool json : {false, true}) {
        Words arguments = {file, "--to", to};
        if (json) arguments.emplace_back("--json");
        const ProgramResult asked = info(arguments);
        EXPECT_EQ(asked.status, 2);
        EXPECT_EQ(asked.out, "");
        EXPECT_NE(asked.err.find("holds 4 volumes; choose one with --volume 1 to 4"),
                  std::string::npos)
            << asked.err;
    }
    EXPECT_EQ(info({file, "--to", to, "--volume", "5"}).status, 2);
    EXPECT_EQ(info({file, "--to", to, "--volume", "0"}).status, 2);
    EXPECT_EQ(info({file, "--volume", "2"}).status, 2) << "nothing is written without --to";
    EXPECT_FALSE(fs::exists(to));
    EXPECT_EQ(info({file, "--to", to, "--volume", "4"}).status, 0);
    EXPECT_TRUE(fs::exists(to));
}

TEST_F(InfoTest, RefusesATargetBeforeItDecodes) {
    const std::string file = write("zeros", std::string(100, '\0'));
    const auto refused = [&](const std::string& to) {
        const ProgramResult ran = info({file, "--to", to});
        EXPECT_EQ(ran.out, "");
        EXPECT_NE(ran.err.find(to), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find("Level II"), std::string::npos)
            << "the file was decoded before --to was checked: " << ran.err;
        return ran.status;
    };
    EXPECT_EQ(refused(file), 2) << "the output is the input file itself";
    EXPECT_EQ(refused(directory_.path()), 1);
    EXPECT_EQ(refused(directory_ / "missing" / "x.nc"), 1);
    EXPECT_EQ(refused("/dev/null"), 1);
    EXPECT_EQ(fs::file_size(file), 100U);
}

TEST_F(InfoTest, TheTableHasALineForEachSweep) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = info({testing::real_file("volumes/KBBX20060113_170337.gz")});
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.out.find("68 sweeps, 13623 radials; partial\n  volume 1  from sweep 0 on"),
              std::string::npos)
        << ran.out;
    // Radials are missing in every sweep of this file. The program names eight sweeps and counts
    // the rest. Half of the sweeps lack their last radial, and all volumes but the last are
    // discarded.
    const int facts = 12, blank_and_heading = 2, further_volumes = 3, blank_and_problems = 12;
    EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), 0x0A),
              facts + blank_and_heading + further_volumes + 68 + blank_and_problems)
        << ran.out;
}

}  // namespace
}  // namespace stormcellar::cli
