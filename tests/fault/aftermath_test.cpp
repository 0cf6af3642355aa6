// Tests look_at_aftermath(). It must report nothing about a sound state, and must name each fault.
#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/load.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class AftermathTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        daemon_ = new FaultyDaemon;
        Shipments shipments(daemon_->drop(), 7);
        for (const Shipment& shipment :
             {shipments.volume(Way::whole), shipments.volume(Way::chunks), shipments.junk()}) {
            deliver(shipment);
            delivered_->push_back(shipment.delivered);
        }
        daemon_->start();
        ASSERT_TRUE(daemon_->catches_up(files_of(*delivered_))) << daemon_->log_end();
        ASSERT_EQ(daemon_->stop(), 0);
    }
    static void TearDownTestSuite() {
        delete daemon_;
        delete delivered_;
    }
    // Tests damage these copies. Paths in the copied catalog begin with the drop directory.
    void SetUp() override {
        places_ = daemon_->places();
        fs::copy(places_.state / "catalog", copy_ / "state/catalog", fs::copy_options::recursive);
        fs::copy(places_.cache, copy_ / "cache", fs::copy_options::recursive);
        places_.state = copy_ / "state";
        places_.cache = copy_ / "cache";
    }
    Aftermath look() { return look_at_aftermath(places_, *delivered_); }
    void expect_problem(const std::string& text) {
        const Aftermath after = look();
        EXPECT_FALSE(after.holds());
        EXPECT_THAT(after.problems, Contains(HasSubstr(text)));
    }
    void change(const std::string& database, const std::string& statement) {
        SQLite::Database opened((places_.state / "catalog" / database).native(),
                                SQLite::OPEN_READWRITE);
        EXPECT_GT(opened.exec(statement), 0);
    }
    fs::path grid() {
        for (const auto& entry : fs::recursive_directory_iterator(places_.cache / "XFAA"))
            if (entry.path().extension() == ".scg") return entry.path();
        return {};
    }
    struct Copy {
        Copy() { fs::create_directory(directory / "state"); }
        fs::path operator/(const char* name) const { return directory / name; }
        testing::TemporaryDirectory directory;
    };
    static inline FaultyDaemon* daemon_ = nullptr;
    static inline auto* delivered_ = new std::vector<Delivered>;
    Copy copy_;
    Places places_;
};

TEST_F(AftermathTest, HasNothingToSayOfWhatIsSound) {
    const Aftermath after = look();
    EXPECT_TRUE(after.holds()) << after.problem_text();
    EXPECT_EQ(after.files, after.rows);
    EXPECT_EQ(after.files, 2 + delivered_->at(1).files.size());
    EXPECT_EQ(after.volumes, 2U);
    EXPECT_EQ(after.gridded, 2U);
    EXPECT_EQ(after.grids, 2U);
    EXPECT_EQ(after.with_reason, 1U);
}

TEST_F(AftermathTest, NamesARowThatIsMissing) {
    change("XFAA.sqlite", "PRAGMA foreign_keys = ON; DELETE FROM file");
    expect_problem("is not registered");
}

TEST_F(AftermathTest, NamesARowThatStandsInTwoDatabases) {
    SQLite::Database other((places_.state / "catalog/_unknown.sqlite").native(),
                           SQLite::OPEN_READWRITE);
    other.exec("ATTACH '" + (places_.state / "catalog/XFAA.sqlite").native() + "' AS a");
    EXPECT_EQ(other.exec("INSERT INTO main.file SELECT 1000 + id, path, size_bytes, modified_ns, "
                         "content_hash, state, reason, registered_ms FROM a.file"),
              1);
    expect_problem("is registered 2 times");
}

TEST_F(AftermathTest, NamesARowThatIsNotSettledOrSaysNoReason) {
    change("XFAA.sqlite", "UPDATE file SET state = 'seen'");
    expect_problem("its state is seen");
    change("XFAA.sqlite", "UPDATE file SET state = 'gone'");
    expect_problem("its state is gone");
    change("_unknown.sqlite", "UPDATE file SET reason = ''");
    expect_problem("rejected, and no reason");
}

TEST_F(AftermathTest, NamesWhatIsToldWrongly) {
    change("XFAA.sqlite", "UPDATE file SET state = 'partial', reason = 'x'");
    expect_problem("is partial (x)");
    change("XFAA.sqlite", "UPDATE file SET size_bytes = 1");
    expect_problem("registered with 1 bytes");
    change("XFAA.sqlite", "UPDATE file SET path = 'nowhere'");
    expect_problem("nowhere: was never delivered");
}

TEST_F(AftermathTest, NamesAPartThatIsCalledCompleteAndJunkThatIsNotRejected) {
    std::vector<Delivered> other = *delivered_;
    other[0].contents = Contents::part;
    EXPECT_THAT(look_at_aftermath(places_, other).problems,
                ElementsAre(HasSubstr("is a part, and registered as complete")));
    other[0].contents = Contents::junk;
    EXPECT_THAT(look_at_aftermath(places_, other).problems,
                ElementsAre(HasSubstr("is complete ()")));
}

TEST_F(AftermathTest, NamesAGridThatIsMissingOrDamaged) {
    const fs::path path = grid();
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(fs::file_size(path)) - 3);
    file.put('\x55');
    file.close();
    expect_problem(path.native());
    fs::remove(path);
    expect_problem("has no grid");
}

TEST_F(AftermathTest, NamesADatabaseThatIsDamaged) {
    const fs::path path = places_.state / "catalog/XFAB.sqlite";
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4096 + 10);
    for (int i = 0; i < 3000; ++i)
        file.put('x');
    file.close();
    expect_problem("XFAB.sqlite");
}

TEST_F(AftermathTest, NamesWhatWasLeftBehind) {
    const std::string name = own_temporary_prefix() + "1";
    for (const fs::path& directory :
         {places_.state, places_.state / "catalog", places_.cache, places_.cache / "XFAA"}) {
        std::ofstream(directory / name) << "x";
        expect_problem((directory / name).native() + ": was left behind");
        fs::remove(directory / name);
    }
    EXPECT_TRUE(look().holds());
    std::ofstream(places_.drop / "stray") << "x";
    expect_problem("nobody delivered it");
    fs::remove(places_.drop / "stray");
}

}  // namespace
}  // namespace stormcellar::fault
