#include "tests/fault/faulty_daemon.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <SQLiteCpp/SQLiteCpp.h>

#include "tests/fault/load.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Makes grids of 100 columns and three levels, and keeps waits short.
constexpr const char* quick =
    "[watch]\nrescan_seconds = 2\n[cache]\npercent = 0\n[ingest]\nquiet_seconds = 1\n"
    "reread_seconds = 0.05\nspacing_km = 10\nextent_km = [100, 100]\nlevels_km = [1, 3, 6]\n"
    "workers = 2\n";

std::size_t settled_in(const fs::path& database) {
    try {
        const SQLite::Database opened(database.native(), SQLite::OPEN_READONLY, 1000);
        SQLite::Statement count(opened,
                                "SELECT count(*) FROM file WHERE state NOT IN ('seen', 'gone')");
        count.executeStep();
        return static_cast<std::size_t>(count.getColumn(0).getInt64());
    } catch (const SQLite::Exception&) {
        return 0;  // the catalog is being made, or a test has damaged it: try again
    }
}

}  // namespace

int number_of(const char* variable, int usual) {
    const char* text = std::getenv(variable);
    return text == nullptr ? usual : static_cast<int>(std::strtol(text, nullptr, 10));
}

void FaultyDaemon::start(const std::map<std::string, std::string>& environment,
                         const std::string& more) {
    fs::remove(running_.root() / "state/status.json");
    running_.start(quick + more + usual_station_tables(), environment);
}

void FaultyDaemon::kill() {
    running_.signal(SIGKILL);
    if (running_.wait() != -SIGKILL) throw std::runtime_error("it ended before:\n" + log_end());
}

pid_t FaultyDaemon::id() const {
    return running_.status().at("pid").get<pid_t>();
}

std::size_t FaultyDaemon::settled() const {
    std::size_t all = 0;
    std::error_code error;
    for (fs::directory_iterator at(running_.catalog(), error), end; !error && at != end;
         at.increment(error)) {
        if (at->path().extension() == ".sqlite") all += settled_in(at->path());
    }
    return all;
}

bool FaultyDaemon::catches_up(std::size_t files, int seconds) const {
    return testing::eventually(
        [&] {
            const json now = running_.status();
            return !now.is_null() && now["state"] == "running" && now["pending"]["waiting"] == 0 &&
                   now["pending"]["running"] == 0 && now["pending"]["growing"] == 0 &&
                   settled() >= files;
        },
        std::chrono::seconds{seconds});
}

std::string FaultyDaemon::log_end() const {
    const std::string log = running_.log();
    return log.size() > 6000 ? log.substr(log.size() - 6000) : log;
}

std::size_t files_of(const std::vector<Delivered>& delivered) {
    std::size_t files = 0;
    for (const Delivered& one : delivered)
        files += one.files.size();
    return files;
}

}  // namespace stormcellar::fault
