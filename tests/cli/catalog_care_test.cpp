// Runs `stormcellar catalog` as a user does, on files and databases that other programs have
// changed.
#include <chrono>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/small_sequence.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using nlohmann::json;
using testing::ProgramResult;

class CatalogCare : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(directory_ / "state");
        fs::create_directories(drop_ / "KBGM");
        for (const std::string& name : {first_, second_})
            testing::write_small_volume(name, raw(name));
        const auto rebuilt = run({"rebuild", "--drop", drop_});
        ASSERT_EQ(rebuilt.status, 0) << rebuilt.err;
    }
    [[nodiscard]] fs::path raw(const std::string& name) const { return drop_ / "KBGM" / name; }
    ProgramResult run(const Words& arguments) {
        return cli::run(with({"catalog"}, arguments, {"--catalog", catalog_}));
    }
    // Copies or decodes the cataloged files of KBGM.
    ProgramResult get(const std::string& out, bool decode) {
        Words arguments = {"get", "--station", "KBGM", "-o", directory_ / out};
        if (decode) arguments.emplace_back("--decode");
        return run(arguments);
    }
    [[nodiscard]] std::size_t files_in(const std::string& out) const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(directory_ / out), fs::directory_iterator{}));
    }
    // Adds the database of another station, as if from an older configuration.
    void put_database(const std::string& station) {
        auto catalog = *catalog::CatalogWriter::open(catalog_);
        catalog::FileFacts facts;
        facts.path = "/d/" + station;
        facts.station = station;
        facts.state = catalog::FileState::gone;
        ASSERT_TRUE(catalog.register_file(facts));
    }
    testing::TemporaryDirectory directory_;
    fs::path drop_ = directory_ / "drop";
    fs::path catalog_ = directory_ / "state/catalog";
    std::string first_ = testing::small_sequence[0], second_ = testing::small_sequence[1];
};

// 2026-11-24: if a link had replaced a file, `get` followed the link with the rights of its user.
TEST_F(CatalogCare, GetDoesNotFollowALinkInAFilesPlace) {
    fs::rename(raw(first_), directory_ / "secret");
    fs::create_symlink(directory_ / "secret", raw(first_));
    for (const bool decode : {false, true}) {
        const std::string out = decode ? "decoded" : "copied";
        const auto ran = get(out, decode);
        EXPECT_EQ(ran.status, 1);
        EXPECT_NE(ran.err.find(raw(first_).native() + ": is a symbolic link"), std::string::npos)
            << ran.err;
        EXPECT_EQ(files_in(out), 1U) << "only the other file is copied";
    }
}

TEST_F(CatalogCare, GetDoesNotFollowALinkInADirectorysPlace) {
    fs::rename(drop_ / "KBGM", directory_ / "elsewhere");
    fs::create_directory_symlink(directory_ / "elsewhere", drop_ / "KBGM");
    for (const bool decode : {false, true}) {
        const std::string out = decode ? "decoded" : "copied";
        EXPECT_EQ(get(out, decode).status, 1);
        EXPECT_EQ(files_in(out), 0U);
    }
}

TEST_F(CatalogCare, GetDoesNotGiveOtherContentsOfTheSameSize) {
    const auto size = fs::file_size(raw(second_));
    fs::copy_file(raw(first_), raw(second_), fs::copy_options::overwrite_existing);
    fs::resize_file(raw(second_), size);
    for (const bool decode : {false, true}) {
        const std::string out = decode ? "decoded" : "copied";
        const auto ran = get(out, decode);
        EXPECT_EQ(ran.status, 1);
        EXPECT_NE(ran.err.find("is not the file that was cataloged"), std::string::npos) << ran.err;
        EXPECT_EQ(files_in(out), 1U) << "only the other file is decoded";
    }
}

// 2026-11-24: one database that could not be opened ended the listing of all stations.
TEST_F(CatalogCare, OneDatabaseThatCannotBeReadIsNamedAndTheOthersAreListed) {
    ASSERT_EQ(::mkfifo((catalog_ / "KAAA.sqlite").c_str(), 0600), 0);
    for (const char* query : {"list", "stations"}) {
        const auto ran = run({query});
        EXPECT_EQ(ran.status, 1) << query;
        EXPECT_NE(ran.out.find("KBGM"), std::string::npos) << ran.out;
        EXPECT_NE(ran.err.find("KAAA.sqlite: is a FIFO"), std::string::npos) << ran.err;
        EXPECT_GE(json::parse(run({query, "--json"}).out).size(), 1U);
    }
    const auto checked = run({"check"});
    EXPECT_EQ(checked.status, 1);
    EXPECT_NE(checked.out.find("2 files  sound"), std::string::npos) << checked.out;
    EXPECT_NE(checked.err.find("KAAA.sqlite: is a FIFO"), std::string::npos) << checked.err;
    EXPECT_EQ(run({"list", "--station", "KBGM"}).status, 0);
    const auto rebuilt = run({"rebuild", "--drop", drop_, "--stations", "known"});
    EXPECT_EQ(rebuilt.status, 0) << "KAAA is no known station, so its database is left alone: "
                                 << rebuilt.err;
}

TEST_F(CatalogCare, DatabasesOfUnknownStationsAreSaidAndCleared) {
    for (const char* station : {"XAAA", "XBBB", "XCCC"})
        put_database(station);
    const auto checked = run({"check"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_NE(checked.out.find("0 changed, not a known station"), std::string::npos) << checked.out;
    EXPECT_NE(checked.out.find("3 databases are of unknown stations"), std::string::npos);
    EXPECT_EQ(run({"check", "--stations", "any"}).out.find("no known"), std::string::npos);
    EXPECT_EQ(run({"check", "--stations", "known,XAAA,XBBB,XCCC"}).out.find("no known"),
              std::string::npos);
    EXPECT_EQ(run({"check", "--stations", "xaaa"}).status, 2);
    {
        const auto daemon = pipeline::InstanceLock::acquire(directory_ / "state");
        const auto refused = run({"check", "--clear-unknown"});
        EXPECT_EQ(refused.status, 1);
        EXPECT_NE(refused.err.find("while no daemon runs"), std::string::npos) << refused.err;
    }
    EXPECT_EQ(
        json_of(run({"check", "--clear-unknown", "--stations", "known,XBBB", "--json"}))["cleared"]
            .size(),
        2U);
    EXPECT_TRUE(fs::exists(catalog_ / "XBBB.sqlite"));
    const auto rest = run({"check", "--clear-unknown"});
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_NE(rest.out.find("XBBB      removed, 1 file, 0 of them will be read again"),
              std::string::npos)
        << rest.out;
    EXPECT_FALSE(fs::exists(catalog_ / "XBBB.sqlite"));
    EXPECT_EQ(run({"list", "--station", "KBGM"}).status, 0);
}

// An attacker makes thousands of databases. The commands still need few descriptors and little
// time.
TEST_F(CatalogCare, ThousandsOfDatabasesAreCheckedAndClearedWithFewDescriptors) {
    put_database("XAAA");
    constexpr int databases = 1500;
    for (int k = 0; k < databases; ++k)
        fs::copy_file(catalog_ / "XAAA.sqlite", catalog_ / fmt::format("Y{:03X}.sqlite", k));
    const auto limited = [&](const std::string& command) {
        const std::string line = fmt::format("ulimit -n 60 && exec {} catalog {} --catalog {}",
                                             STORMCELLAR_PROGRAM, command, catalog_.native());
        return testing::run_program("/bin/sh", {"-c", line});
    };
    const auto checked = limited("check");
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_NE(checked.out.find("1501 databases are of unknown stations"), std::string::npos);
    EXPECT_EQ(limited("stations").status, 0);
    EXPECT_EQ(limited("list --rejected").status, 0);
    EXPECT_EQ(limited("rebuild --drop " + drop_.native()).status, 0);
    const auto cleared = limited("check --clear-unknown");
    EXPECT_EQ(cleared.status, 0) << cleared.err;
    for (const auto& entry : fs::directory_iterator(catalog_)) {
        const std::string name = entry.path().filename();
        EXPECT_TRUE(name.starts_with("KBGM.sqlite") || name == "drop-directory") << name;
    }
}

}  // namespace
}  // namespace stormcellar::cli
