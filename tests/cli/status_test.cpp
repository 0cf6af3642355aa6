// Tests `stormcellar status` with the real daemon, without a daemon, and with another program on
// the daemon's socket.
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "cli/query/status_source.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {
namespace {

using daemon::RunningDaemon;
using daemon::write_file;
using nlohmann::json;

testing::ProgramResult status(const Words& arguments) {
    return run(with({"status"}, arguments));
}

// Waits until the daemon answers, which means that it is ready.
bool wait_until_it_answers(const fs::path& state) {
    return testing::eventually([&] { return status({"--state", state}).status == 0; });
}

bool is_asked_for_files(const json& document) {
    return document["rejected"] == 1 && document["pending"]["waiting"] == 0;
}

TEST(Status, TheRunningDaemonAnswers) {
    RunningDaemon daemon;
    write_file(daemon.drop() / "KTLX_junk", std::string(5000, 'x'));
    daemon.start("[ingest]\nquiet_seconds = 1\n");
    ASSERT_TRUE(daemon.wait_for(is_asked_for_files)) << daemon.log();
    ASSERT_TRUE(wait_until_it_answers(daemon.root() / "state")) << daemon.log();
    const json document = json_of(status({"--state", daemon.root() / "state", "--json"}));
    EXPECT_EQ(document["source"]["answered"], true);
    EXPECT_EQ(document["source"]["from"], (daemon.root() / "state/status.sock").native());
    EXPECT_EQ(document["rejected_by"], json({{"not_level2", 1}}));
    EXPECT_EQ(document["stations"][0]["station"], "KTLX");
    const auto table = status({"--config", daemon.root() / "stormcellard.toml"});
    EXPECT_EQ(table.status, 0) << table.err;
    EXPECT_NE(table.out.find(": running, started"), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("\nKTLX "), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("KTLX_junk: not_level2 ("), std::string::npos) << table.out;
    EXPECT_EQ(table.err, "");
    EXPECT_EQ(status({"--socket", daemon.root() / "state/status.sock"}).status, 0);
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();
}

TEST(Status, OfAKilledDaemonIsWhatItsFileSays) {
    RunningDaemon daemon;
    daemon.start();
    ASSERT_TRUE(wait_until_it_answers(daemon.root() / "state")) << daemon.log();
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "running"; }));
    daemon.signal(SIGKILL);
    EXPECT_EQ(daemon.wait(), -SIGKILL);
    const auto after = status({"--state", daemon.root() / "state", "--json"});
    EXPECT_EQ(after.status, 1);
    EXPECT_NE(after.err.find("stormcellar: no daemon answers ("), std::string::npos) << after.err;
    EXPECT_NE(after.err.find("status.json, "), std::string::npos) << after.err;
    const json document = json::parse(after.out);
    EXPECT_EQ(document["source"]["answered"], false);
    EXPECT_TRUE(document["source"]["age_s"].is_number());
    EXPECT_EQ(document["state"], "running") << "the file keeps the last reported state";
    EXPECT_EQ(status({"--socket", daemon.root() / "state/status.sock"}).status, 1);
    // A daemon starts although a killed daemon has left its socket behind.
    daemon.start();
    EXPECT_TRUE(wait_until_it_answers(daemon.root() / "state")) << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();
}

TEST(Status, ASocketElsewhereIsFound) {
    RunningDaemon daemon;
    daemon.start("[status]\nsocket = \"elsewhere.sock\"\n");
    ASSERT_TRUE(wait_until_it_answers(daemon.root() / "state")) << daemon.log();
    const auto by_config = status({"--config", daemon.root() / "stormcellard.toml"});
    EXPECT_EQ(by_config.status, 0) << by_config.err;
    EXPECT_FALSE(fs::exists(daemon.root() / "state/status.sock"));
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();
}

// Without its socket the daemon ingests files but does not report that it is ready.
TEST(Status, TheDaemonStartsWithoutItsSocket) {
    RunningDaemon daemon;
    write_file(daemon.drop() / "junk", "no radar data");
    daemon.start("[status]\nsocket = \"none/status.sock\"\n");
    EXPECT_TRUE(daemon.wait_for_log("the status cannot be served: ")) << daemon.log();
    EXPECT_TRUE(daemon.wait_for_log("not ready: ")) << daemon.log();
    EXPECT_TRUE(daemon.wait_for_log("rejected ")) << daemon.log();
    EXPECT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "starting"; }));
    EXPECT_EQ(daemon.log().find("ready: watching"), std::string::npos) << daemon.log();
    EXPECT_EQ(status({"--config", daemon.root() / "stormcellard.toml"}).status, 1);
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();
}

TEST(Status, SaysWhereNobodyAnswers) {
    const testing::TemporaryDirectory directory;
    const auto nobody = status({"--state", directory.path()});
    EXPECT_EQ(nobody.status, 1);
    EXPECT_EQ(nobody.out, "");
    EXPECT_EQ(nobody.err, "stormcellar: no daemon answers (" + directory.path().native() +
                              "/status.sock: No such file or directory), and " +
                              directory.path().native() + "/status.json holds no status\n");
    write_file(directory / "status.json", "[half");
    EXPECT_EQ(status({"--state", directory.path()}).status, 1);
    EXPECT_EQ(status({"--config", directory / "none.toml"}).status, 1);
    EXPECT_EQ(status({"--socket", "a", "--state", "b"}).status, 2);
    EXPECT_EQ(status({"--socket", ""}).status, 2);
    EXPECT_EQ(status({"something"}).status, 2);
}

TEST(StatusPlaces, AreWhereItIsSaid) {
    const testing::TemporaryDirectory directory;
    const fs::path file = directory / "s.toml";
    write_file(file, "[paths]\nstate = \"st\"\n[status]\nsocket = \"run/s\"\n[unknown]\nkey = 1\n");
    StatusOptions options;
    options.config = file;
    auto places = places_of(options);
    ASSERT_TRUE(places) << places.error().message;
    EXPECT_EQ(places->sockets, std::vector<fs::path>{directory / "run/s"});
    EXPECT_EQ(places->file, directory / "st/status.json");
    EXPECT_EQ(places->loops, directory / "st/loops/status.json");
    write_file(file, "[paths\n");
    EXPECT_EQ(places_of(options).error().code, ErrorCode::bad_argument);
    options = {};
    options.state = directory.path();
    write_file(directory / "status.json", R"({"listening": {"socket": "/run/x/s.sock"}})");
    EXPECT_EQ(places_of(options)->sockets,
              (std::vector<fs::path>{directory / "status.sock", "/run/x/s.sock"}));
    options = {};
    EXPECT_EQ(places_of(options)->sockets.at(0), "/run/stormcellar/status.sock");
    EXPECT_EQ(places_of(options)->file, "/var/lib/stormcellar/status.json");
    EXPECT_EQ(places_of(options)->loops, "/var/lib/stormcellar/loops/status.json");
    options.socket = "/s";
    EXPECT_EQ(places_of(options)->loops, "");
}

TEST(StatusLoops, OfAProcessOfTheirOwnAreShown) {
    const testing::TemporaryDirectory directory;
    const fs::path file = directory / "status.json";
    json keeper = {{"state", "running"},
                   {"pid", ::getpid()},
                   {"loops", {{"running", 1}, {"each", {{{"name", "plains"}}}}}}};
    write_file(file, keeper.dump());
    const json none = {{"loops", {{"running", 0}, {"each", json::array()}}}};
    json document = none;
    add_loops(document, file);
    EXPECT_EQ(document["loops"], keeper["loops"]);
    EXPECT_EQ(document["loops_service"],
              (json{{"state", "running"}, {"pid", ::getpid()}, {"alive", true}}));

    json own = {{"loops", {{"running", 1}, {"each", {{{"name", "its own"}}}}}}};
    const json before = own;
    add_loops(own, file);
    EXPECT_EQ(own, before) << "the daemon keeps its own loops";

    for (const std::string& text : {std::string{"[1]"}, std::string{"{}"}, std::string{"{half"}}) {
        write_file(file, text);
        document = none;
        add_loops(document, file);
        EXPECT_EQ(document, none) << text;
    }
    document = none;
    add_loops(document, directory / "nothing");
    add_loops(document, {});
    EXPECT_EQ(document, none);

    // The daemon's configuration names two loops, but the file has only one loop.
    write_file(file, keeper.dump());
    const json two = {
        {"loops",
         {{"running", 0},
          {"elsewhere", true},
          {"each",
           {{{"name", "plains"}, {"running", false}}, {{"name", "coast"}, {"running", false}}}}}}};
    document = two;
    add_loops(document, file);
    EXPECT_EQ(document["loops"]["each"],
              (json{{{"name", "plains"}}, {{"name", "coast"}, {"running", false}}}));
    document = two;
    add_loops(document, directory / "nothing");
    EXPECT_EQ(document, two) << "the document stays unchanged without a file";

    // A killed keeper leaves its last status, although its loops no longer run.
    keeper["loops"]["each"][0]["running"] = true;
    for (const json& pid : {json(-1), json(0), json("x"), json(0x7FFFFFF0)}) {
        keeper["pid"] = pid;
        write_file(file, keeper.dump());
        document = none;
        add_loops(document, file);
        EXPECT_EQ(document["loops_service"]["alive"], false) << pid;
        EXPECT_EQ(document["loops"]["running"], 0) << pid;
        EXPECT_EQ(document["loops"]["each"][0]["running"], false) << pid;
    }
}

TEST(StatusLoops, StandBesideWhatTheDaemonAnswers) {
    RunningDaemon ingest;
    ingest.start("", {}, {"--no-loops"});
    ASSERT_TRUE(wait_until_it_answers(ingest.root() / "state")) << ingest.log();
    const auto alone = status({"--state", ingest.root() / "state", "--json"});
    EXPECT_FALSE(json::parse(alone.out).contains("loops_service"));
    fs::create_directories(ingest.root() / "state/loops");
    write_file(ingest.root() / "state/loops/status.json",
               R"({"state": "running", "pid": 1, "loops": {"running": 1, "each":
                   [{"name": "plains", "running": true}]}})");
    const auto table = status({"--config", ingest.root() / "stormcellard.toml"});
    EXPECT_EQ(table.status, 0);
    EXPECT_NE(table.out.find("; run by process 1: running\n"), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("\nplains "), std::string::npos) << table.out;
    EXPECT_EQ(ingest.terminate(), 0) << ingest.log();
}

// Returns the error of ask_socket() if a server answers with this text; bad_argument if
// ask_socket() succeeds.
ErrorCode code_of_answer(const std::string& answer) {
    const testing::TemporaryDirectory directory;
    const fs::path path = directory / "s";
    const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.native().copy(static_cast<char*>(address.sun_path), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(listening, 1), 0);
    std::thread server([&] {
        const int asked = ::accept(listening, nullptr, nullptr);
        std::string question(100, '\0');
        (void)!::read(asked, question.data(), question.size());
        (void)!::send(asked, answer.data(), answer.size(), MSG_NOSIGNAL);
        ::close(asked);
    });
    const auto document = ask_socket(path);
    server.join();
    ::close(listening);
    return document ? ErrorCode::bad_argument : document.error().code;
}

TEST(AskSocket, WhoMayNotAskIsToldHowToBeLetIn) {
    const testing::TemporaryDirectory directory;
    write_file(directory / "s", "");
    ASSERT_EQ(::chown((directory / "s").c_str(), static_cast<uid_t>(-1), ::getgid()), 0);
    const std::string group = ::getgrgid(::getgid())->gr_name;
    EXPECT_EQ(how_to_be_let_in(directory / "s"), "; only members of the group " + group +
                                                     " may ask: run sudo usermod -aG " + group +
                                                     " USER, then log in again");
    EXPECT_EQ(how_to_be_let_in(directory / "none"), "");
}

TEST(AskSocket, WhoIsNoDaemonIsSeen) {
    EXPECT_EQ(code_of_answer(""), ErrorCode::corrupt);
    EXPECT_EQ(code_of_answer("220 mail ready\r\n"), ErrorCode::corrupt);
    EXPECT_EQ(code_of_answer("HTTP/1.0 200 OK\r\n\r\n<html>"), ErrorCode::corrupt);
    EXPECT_EQ(code_of_answer("HTTP/1.0 200 OK\r\n\r\n[1]"), ErrorCode::corrupt);
    EXPECT_EQ(code_of_answer("HTTP/1.0 503 Wait\r\n\r\nstarting"), ErrorCode::io);
    EXPECT_EQ(code_of_answer("HTTP/1.0 200 OK\r\n\r\n{}"), ErrorCode::bad_argument) << "{}";
    const std::vector<char> too_long(20'000'000, 'x');
    EXPECT_EQ(code_of_answer({too_long.begin(), too_long.end()}), ErrorCode::corrupt);
    EXPECT_EQ(ask_socket("/" + std::string(200, 'x')).error().code, ErrorCode::io);
}

// 2026-11-25: --json printed names unescaped, and a terminal obeyed U+009B and U+202E in the names.
TEST(Status, JsonIsAsciiAndSaysTheSame) {
    const testing::TemporaryDirectory directory;
    const std::string name = "a\u009B31m\u202E\u2028\u00E9";
    write_file(directory / "status.json", json{{"state", name}}.dump());
    const auto ran = status({"--state", directory.path(), "--json"});
    for (const char byte : ran.out)
        EXPECT_TRUE(byte == '\n' || (byte >= ' ' && byte <= '~')) << ran.out;
    EXPECT_EQ(json::parse(ran.out)["state"], name);
}

}  // namespace
}  // namespace stormcellar::cli
