#include "tests/fault/hostile_watch.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/grid_name.h"
#include "tests/daemon/notify_socket.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::uint64_t block = 512;  // the unit of st_blocks

// Visits the readable entries below a directory; leaves out entries that vanish meanwhile.
void for_each_entry(const fs::path& directory,
                    const std::function<void(const fs::directory_entry&)>& see) {
    std::error_code error;
    for (fs::directory_iterator at(directory, error), end; !error && at != end; at.increment(error))
        see(*at);
}

void read_rows(const fs::path& path, std::multimap<fs::path, CatalogRow>& rows) {
    try {
        const SQLite::Database database(path.native(), SQLite::OPEN_READONLY, 10'000);
        SQLite::Statement found(database, "SELECT path, state, reason FROM file");
        while (found.executeStep()) {
            rows.emplace(fs::path{found.getColumn(0).getString()},
                         CatalogRow{path.stem().native(), found.getColumn(1).getString(),
                                    found.getColumn(2).getString()});
        }
    } catch (const SQLite::Exception&) {
        return;  // the caller notices that its rows are missing
    }
}

}  // namespace

std::multimap<fs::path, CatalogRow> catalog_rows(const fs::path& catalog) {
    std::multimap<fs::path, CatalogRow> rows;
    for_each_entry(catalog, [&](const fs::directory_entry& entry) {
        if (entry.path().extension() == ".sqlite" && entry.is_regular_file())
            read_rows(entry.path(), rows);
    });
    return rows;
}

std::set<std::string> databases_in(const fs::path& catalog) {
    std::set<std::string> names;
    for_each_entry(catalog, [&](const fs::directory_entry& entry) {
        if (entry.path().extension() == ".sqlite") names.insert(entry.path().stem().native());
    });
    return names;
}

std::set<std::string> domains_in(const fs::path& cache) {
    std::set<std::string> names;
    for_each_entry(cache, [&](const fs::directory_entry& entry) {
        std::error_code error;
        const std::string name = entry.path().filename().native();
        if (entry.is_directory(error) && cache::is_domain_name(name)) names.insert(name);
    });
    return names;
}

std::set<std::string> invented_among(const std::set<std::string>& names) {
    std::set<std::string> invented;
    for (const std::string& name : names) {
        if (name != "_unknown" && !find_station(name)) invented.insert(name);
    }
    return invented;
}

std::size_t open_descriptors(pid_t process) {
    std::size_t count = 0;
    for_each_entry("/proc/" + std::to_string(process) + "/fd",
                   [&](const fs::directory_entry&) { ++count; });
    return count;
}

double cpu_seconds(pid_t process) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(stat, text);
    const std::size_t behind_name = text.rfind(')');
    if (behind_name == std::string::npos) return 0;
    std::istringstream fields(text.substr(behind_name + 2));
    constexpr int before_times = 11;  // fields from the state to the times
    for (int i = 0; i < before_times; ++i)
        fields >> text;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

std::uint64_t unnamed_bytes(pid_t process) {
    std::uint64_t bytes = 0;
    for_each_entry("/proc/" + std::to_string(process) + "/fd",
                   [&](const fs::directory_entry& entry) {
                       struct stat facts {};
                       if (::stat(entry.path().c_str(), &facts) != 0) return;
                       if (S_ISREG(facts.st_mode) && facts.st_nlink == 0)
                           bytes += static_cast<std::uint64_t>(facts.st_blocks) * block;
                   });
    return bytes;
}

std::uint64_t disk_bytes_below(const fs::path& directory) {
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator at(directory, error), end; !error && at != end;
         at.increment(error)) {
        struct stat facts {};
        if (::lstat(at->path().c_str(), &facts) == 0)
            bytes += static_cast<std::uint64_t>(facts.st_blocks) * block;
    }
    return bytes;
}

bool has_whole_grid(const fs::path& cache, const std::string& station, UtcTime time) {
    const auto grid =
        cache::GridFile::open(cache / cache::relative_path({station, level2::Moment::ref, time}));
    return grid && !grid->description().provenance.partial;
}

bool comes_true(double seconds, const std::function<bool()>& wanted) {
    return testing::eventually(wanted, std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds)));
}

bool comes_to_rest(const daemon::RunningDaemon& daemon, double seconds) {
    constexpr double hardly_s = 0.1;
    constexpr milliseconds long_rest{1200};
    auto since = Clock::now();
    double before_s = cpu_seconds(daemon.id());
    return comes_true(seconds, [&] {
        const nlohmann::json now = daemon.status();
        const bool is_at_work =
            now.is_null() || now["pending"]["waiting"] != 0 || now["pending"]["running"] != 0;
        if (is_at_work || cpu_seconds(daemon.id()) - before_s >= hardly_s) {
            since = Clock::now();
            before_s = cpu_seconds(daemon.id());
        }
        return Clock::now() - since >= long_rest;
    });
}

// Closes the socket after READY=1, because an open socket that nobody reads could block the daemon.
double start_until_ready(daemon::RunningDaemon& daemon, const std::string& config) {
    const fs::path path = daemon.root() / "notify";
    fs::remove(path);
    fs::remove(daemon.root() / "state/status.json");
    daemon::NotifySocket socket(path);
    ::chmod(path.c_str(), 0777);
    const auto begin = Clock::now();
    daemon.start(config, {{"NOTIFY_SOCKET", path.native()}});
    while (Clock::now() < begin + std::chrono::seconds{30}) {
        if (socket.receive().find("READY=1") != std::string::npos)
            return std::chrono::duration<double>(Clock::now() - begin).count();
        if (daemon.ended()) throw std::runtime_error("it ended before it was ready");
    }
    throw std::runtime_error("it is not ready after 30 s");
}

}  // namespace stormcellar::fault
