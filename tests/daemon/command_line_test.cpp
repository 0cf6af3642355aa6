// Tests that stormcellard reports wrong arguments and wrong configurations clearly.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

TEST(CommandLine, BadUsageAndBadConfigurationsAreClear) {
    const testing::TemporaryDirectory directory;
    EXPECT_EQ(testing::run_program(STORMCELLARD, {}).status, 2);
    const auto refused = [](const std::vector<std::string>& arguments, const std::string& why) {
        const auto ran = testing::run_program(STORMCELLARD, arguments);
        EXPECT_EQ(ran.status, 2);
        EXPECT_TRUE(ran.err.starts_with("stormcellard: " + why + "\nusage: ")) << ran.err;
    };
    refused({"--config"}, "--config: give a file");
    refused({"--config", "x", "more"}, "more: is not an option");
    refused({"--bogus", "--config", "x"}, "--bogus: is not an option");
    refused({"--no-loops"}, "--config FILE must be given");
    refused({"--config", "x", "--loops-only", "--no-loops"},
            "--loops-only and --no-loops cannot be given together");
    EXPECT_EQ(testing::run_program(STORMCELLARD, {"--help"}).status, 0);
    EXPECT_TRUE(testing::run_program(STORMCELLARD, {"--version"}).out.starts_with("stormcellard "));
    EXPECT_TRUE(
        testing::run_program(STORMCELLAR_PROGRAM, {"--version"}).out.starts_with("stormcellar "));

    const fs::path file = directory / "c.toml";
    const auto run = [&](const std::string& text, std::vector<std::string> more = {}) {
        write_file(file, text);
        std::vector<std::string> arguments = {"--config", file.native()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return testing::run_program(STORMCELLARD, arguments);
    };
    const auto bad = run("[paths]\ndrop = 7\n", {"--check-config"});
    EXPECT_EQ(bad.status, 1);
    EXPECT_EQ(bad.err, fmt::format("stormcellard: {}:2: [paths] drop: must be text in quotes, is a "
                                   "number\n",
                                   file.native()));
    const auto good = run("[paths]\ndrop = \"none\"\n", {"--check-config"});
    EXPECT_EQ(good.status, 0) << "a check does not need the directories";
    EXPECT_EQ(good.err, fmt::format("stormcellard: note: cannot read the drop directory {}: No "
                                    "such file or directory; the service will wait for it\n",
                                    (directory / "none").native()));
    fs::create_directory(directory / "there");
    const auto there = run("[paths]\ndrop = \"there\"\n", {"--check-config"});
    EXPECT_EQ(there.err, "");
    // 2026-11-28: for root, who may read everything, the check accepted a directory that the
    // service may not read.
    const std::string as = ::geteuid() == 0 ? "checked as the user root, who may read everything; "
                                            : "checked as the user ";
    EXPECT_TRUE(there.out.starts_with(as)) << there.out;
    const auto in_home =
        run("[paths]\ndrop = \"/home/no-such-user/drop\"\n", {"--check-config", "--no-loops"});
    EXPECT_NE(in_home.err.find("(ProtectHome=)"), std::string::npos) << in_home.err;
    const auto blocked =
        run("[paths]\ndrop = \"there\"\nstate = \"c.toml/state\"\n", {"--check-config"});
    EXPECT_EQ(blocked.status, 0);
    EXPECT_EQ(blocked.err, fmt::format("stormcellard: note: [paths] state: {} is not a directory, "
                                       "so the service cannot start\n",
                                       file.native()));
    const auto unseen =
        run("[paths]\ndrop = \"none\"\n[[loop]]\nname = \"a\"\nscene = \"gone.toml\"\n",
            {"--check-config"});
    EXPECT_EQ(unseen.status, 1);
    EXPECT_NE(unseen.err.find("c.toml:5: [loop] scene: "), std::string::npos) << unseen.err;
}

}  // namespace
}  // namespace stormcellar::daemon
