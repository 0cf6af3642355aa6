// Runs `stormcellar view` on files as a user does, and ends the program with Ctrl-C.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "tests/web/raw_client.h"
#include "web/doors/viewer/viewer_files.h"

namespace stormcellar::cli {
namespace {

// Sets a variable of the environment while the object exists.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { ::setenv(name_, before_.c_str(), 1); }

  private:
    const char* name_;
    std::string before_;
};

class ViewCommand : public ::testing::Test {
  protected:
    void SetUp() override {
        if (web::viewer_files().empty()) GTEST_SKIP() << "built without the viewer";
        const auto scene = testing::source_directory() / "scenes/small-storm.toml";
        ASSERT_EQ(run({"synth", scene.native(), "-o", at("volumes")}).status, 0);
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (directory_ / name); }

    // Returns the port in the program's output; 0 if there is none.
    static int port_in(const std::string& out) {
        const std::string before = "the viewer is at http://127.0.0.1:";
        const auto found = out.find(before);
        return found == std::string::npos ? 0 : std::atoi(out.c_str() + found + before.size());
    }
    // Makes a fake xdg-open, which writes its argument, an address, into a file.
    void make_desktop() const {
        fs::create_directories(at("bin"));
        std::ofstream(at("bin/xdg-open")) << "#!/bin/sh\necho \"$@\" >'" << at("opened") << "'\n";
        fs::permissions(at("bin/xdg-open"), fs::perms::owner_all);
    }
    [[nodiscard]] std::string opened() const {
        std::string line;
        std::getline(std::ifstream(at("opened")), line);
        return line;
    }

    testing::TemporaryDirectory directory_;
};

TEST_F(ViewCommand, ServesTheViewerAndItsGridsUntilCtrlC) {
    testing::RunningProgram view(STORMCELLAR_PROGRAM, {"view", at("volumes"), "--no-browser"});
    ASSERT_TRUE(testing::eventually([&] { return port_in(view.out()) > 0; })) << view.err();
    const int port = port_in(view.out());
    EXPECT_NE(view.out().find("open this address in a browser; Ctrl-C ends it"), std::string::npos);
    const std::string page = web::RawClient::get(port, "/view/");
    EXPECT_EQ(web::status_in(page), 200);
    EXPECT_NE(page.find("viewer.js"), std::string::npos);
    const std::string domains = web::RawClient::get(port, "/api/v1/domains");
    EXPECT_NE(domains.find("\"REF\""), std::string::npos) << domains;
    EXPECT_EQ(view.end(SIGINT), 0);
    EXPECT_EQ(view.err(), "");
}

TEST_F(ViewCommand, OpensTheBrowserOfTheDesktop) {
    make_desktop();
    const Environment path("PATH", at("bin") + ":" + std::getenv("PATH"));
    const Environment display("DISPLAY", ":0");
    testing::RunningProgram view(STORMCELLAR_PROGRAM, {"view", at("volumes")});
    ASSERT_TRUE(testing::eventually([&] {
        return !opened().empty() && view.out().find("Ctrl-C") != std::string::npos;
    })) << view.err();
    EXPECT_NE(view.out().find("the viewer is at " + opened() + "\nCtrl-C ends it\n"),
              std::string::npos)
        << view.out() << opened();
    EXPECT_EQ(view.end(SIGINT), 0);
}

TEST_F(ViewCommand, LeavesTheBrowserAloneIfItIsAsked) {
    make_desktop();
    const Environment path("PATH", at("bin") + ":" + std::getenv("PATH"));
    const Environment display("DISPLAY", ":0");
    testing::RunningProgram view(STORMCELLAR_PROGRAM, {"view", at("volumes"), "--no-browser"});
    ASSERT_TRUE(testing::eventually([&] { return port_in(view.out()) > 0; }));
    EXPECT_EQ(view.end(SIGINT), 0);
    EXPECT_EQ(opened(), "");
}

TEST_F(ViewCommand, SaysWhatCannotBeShown) {
    EXPECT_EQ(run({"view"}).status, 2);
    const auto missing = run({"view", at("nothing"), "--no-browser"});
    EXPECT_EQ(missing.status, 1);
    EXPECT_NE(missing.err.find(at("nothing")), std::string::npos) << missing.err;
    std::ofstream(at("page.html")) << "<html>";
    const auto other = run({"view", at("page.html"), "--no-browser"});
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.err.find("none of the named files can be gridded"), std::string::npos)
        << other.err;
}

}  // namespace
}  // namespace stormcellar::cli
