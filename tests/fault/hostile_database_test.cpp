// A database that cannot be opened must affect only its own station.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/fault/hostile_cases.h"
#include "tests/fault/hostile_watch.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using testing::slow_down;

enum class Spoilt { permission, fifo, directory };

class OneDatabase : public HostileCases, public ::testing::WithParamInterface<Spoilt> {
  protected:
    // Root may open everything, so the daemon runs as another user.
    OneDatabase() {
        if (::geteuid() != 0) return;
        EXPECT_EQ(::chown(daemon_.root().c_str(), 65534, 65534), 0);
        daemon_.run_under({"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    }
    [[nodiscard]] fs::path database() const { return daemon_.catalog() / "KTLX.sqlite"; }
    [[nodiscard]] fs::path aside() const { return daemon_.root() / "KTLX.aside"; }
    void spoil() {
        fs::rename(database(), aside());
        for (const char* beside : {"-wal", "-shm"})
            fs::remove(database().native() + beside);
        switch (GetParam()) {
            case Spoilt::permission:
                fs::copy_file(aside(), database());
                fs::permissions(database(), fs::perms::none);
                break;
            case Spoilt::fifo:
                ASSERT_EQ(::mkfifo(database().c_str(), 0666), 0);
                break;
            case Spoilt::directory:
                fs::create_directory(database());
                break;
        }
    }
    // Removes whatever is at the database's path, and puts the sound database there.
    void mend() {
        fs::remove_all(database());
        fs::copy_file(aside(), database());
        if (::geteuid() == 0) {
            ASSERT_EQ(::chown(database().c_str(), 65534, 65534), 0);
        }
        fs::permissions(database(), fs::perms{0644});
    }
};

TEST_P(OneDatabase, ThatCannotBeOpenedIsItsStationsTroubleAlone) {
    start();
    expect_gridded("KTLX", put_good("KTLX"));
    stop();
    spoil();
    const std::size_t before = complaints_about("KTLX.sqlite");
    start();
    for (const char* station : {"KFWS", "KINX", "KVNX"})
        expect_gridded(station, put_good(station));
    const UtcTime later = put_good("KTLX", 60);
    put("misc/no-radar-data", Bytes(300, std::byte{'x'}));
    EXPECT_TRUE(comes_true(prompt_s, [&] { return complaints_about("KTLX.sqlite") > before; }))
        << log_end();
    const std::uint64_t scans = daemon_.status()["scans"];
    EXPECT_TRUE(daemon_.wait_for([&](const nlohmann::json& s) { return s["scans"] >= scans + 2; }));
    EXPECT_EQ(complaints_about("KTLX.sqlite"), before + 1) << log_end();
    EXPECT_NE(daemon_.status().dump().find("KTLX.sqlite"), std::string::npos)
        << "the status does not name the database";
    expect_gridded("KAMA", put_good("KAMA"));
    EXPECT_GT(lines_with("misc/no-radar-data ("), 0U) << "the file was not rejected";
    mend();
    expect_gridded("KTLX", later, 30.0 * slow_down);
    EXPECT_EQ(daemon_.status().dump().find("KTLX.sqlite"), std::string::npos)
        << "the status still names the database";
    stop();
    // Read the catalog only now, because a reader that runs as root leaves files of root beside the
    // database.
    EXPECT_EQ(
        catalog_rows(daemon_.catalog()).count(daemon_.drop() / ("KTLX" + format_compact(later))),
        1U);
}

std::string name_of_spoilt(const ::testing::TestParamInfo<Spoilt>& which) {
    if (which.param == Spoilt::permission) return "NoPermission";
    return which.param == Spoilt::fifo ? "Fifo" : "Directory";
}

INSTANTIATE_TEST_SUITE_P(HostileCases, OneDatabase,
                         ::testing::Values(Spoilt::permission, Spoilt::fifo, Spoilt::directory),
                         name_of_spoilt);

}  // namespace
}  // namespace stormcellar::fault
