// Tests that a process that may only read can query while another process writes.
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stormcellar/catalog/catalog.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {
namespace {

// A call that a reader does not offer must not compile.
template <class Catalog>
concept Registers = requires(Catalog& catalog, const FileFacts& facts) {
    catalog.register_file(facts);
    catalog.mark_gone(facts.path);
    catalog.roll();
};
static_assert(Registers<CatalogWriter>);
static_assert(!Registers<CatalogReader> && !Registers<const CatalogWriter>);

FileFacts volume_facts(int number) {
    FileFacts facts;
    facts.path = fmt::format("/d/{}", number);
    facts.station = "KTLX";
    facts.state = FileState::complete;
    VolumeFacts volume;
    volume.start_time = UtcTime{std::chrono::minutes{number}};
    facts.volumes = {volume};
    return facts;
}

// A process of a user who may not write here, which queries the catalog on request. Make it before
// the test opens a database, because a child process must not inherit SQLite's records of open
// files.
class Reader {
  public:
    explicit Reader(const fs::path& directory) {
        if (::pipe(orders_) != 0 || ::pipe(answers_) != 0) return;
        child_ = ::fork();
        if (child_ == 0) serve(directory);
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() {
        ::close(orders_[1]);
        ::waitpid(child_, nullptr, 0);
    }

    // Returns the number of volumes that the process sees; -1 if it cannot read the catalog. The
    // process then writes the error to stderr.
    int count() {
        int answer = -2;
        if (::write(orders_[1], "?", 1) != 1) return -3;
        if (::read(answers_[0], &answer, sizeof answer) != sizeof answer) return -4;
        return answer;
    }

  private:
    [[noreturn]] void serve(const fs::path& directory) {
        ::close(orders_[1]);
        if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(1);
        std::optional<CatalogReader> catalog;
        char order = 0;
        while (::read(orders_[0], &order, 1) == 1) {
            int answer = -1;
            if (::access(directory.c_str(), W_OK) == 0) ::_exit(2);
            if (!catalog) {
                if (auto opened = CatalogReader::open(directory)) {
                    catalog.emplace(std::move(*opened));
                }
            }
            if (catalog) {
                const auto entries = catalog->list("KTLX", {});
                if (entries) answer = static_cast<int>(entries->size());
                if (!entries) fmt::print(stderr, "{}\n", entries.error().message);
            }
            if (::write(answers_[1], &answer, sizeof answer) != sizeof answer) break;
        }
        ::_exit(0);
    }

    int orders_[2] = {-1, -1}, answers_[2] = {-1, -1};
    pid_t child_ = -1;
};

class ReaderRights : public ::testing::Test {
  protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "only root can become a user without rights";
        fs::permissions(directory_.path(), fs::perms{0755});
        ::umask(022);
    }
    void register_one(CatalogWriter& catalog) {
        ASSERT_TRUE(catalog.register_file(volume_facts(number_++)));
    }
    testing::TemporaryDirectory directory_;
    int number_ = 0;
};

TEST_F(ReaderRights, AReaderFollowsALiveWriter) {
    Reader reader(directory_ / "catalog");
    auto writer = *CatalogWriter::open(directory_ / "catalog");
    register_one(writer);
    EXPECT_EQ(reader.count(), 1);
    for (int i = 2; i <= 20; ++i) {
        register_one(writer);
        EXPECT_EQ(reader.count(), i);
    }
}

TEST_F(ReaderRights, AReaderFollowsAWriterThatStopsAndStarts) {
    Reader early(directory_ / "catalog"), late(directory_ / "catalog");
    {
        auto writer = *CatalogWriter::open(directory_ / "catalog");
        register_one(writer);
        EXPECT_EQ(early.count(), 1);
    }
    EXPECT_EQ(early.count(), 1) << "after the writer ended, the file alone is read";
    EXPECT_EQ(late.count(), 1);
    auto writer = *CatalogWriter::open(directory_ / "catalog");
    register_one(writer);
    EXPECT_EQ(late.count(), 2) << "a reader opened without a writer sees later rows";
    EXPECT_EQ(early.count(), 2);
}

TEST_F(ReaderRights, AReaderSeesWhatAKilledWriterLeft) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
        auto catalog = CatalogWriter::open(directory_ / "catalog");
        if (catalog) (void)catalog->register_file(volume_facts(0));
        ::_exit(0);  // does not close the database, so the WAL stays
    }
    ::waitpid(writer, nullptr, 0);
    ASSERT_TRUE(fs::exists(directory_ / "catalog/KTLX.sqlite-wal"));
    Reader reader(directory_ / "catalog");
    EXPECT_EQ(reader.count(), 1);
}

// After a power cut, the WAL may exist without its index, which a reader may not make.
TEST_F(ReaderRights, AWalWithoutItsIndexIsAnErrorUntilAWriterCame) {
    Reader reader(directory_ / "catalog");
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
        auto catalog = CatalogWriter::open(directory_ / "catalog");
        if (catalog) (void)catalog->register_file(volume_facts(0));
        ::_exit(0);
    }
    ::waitpid(writer, nullptr, 0);
    fs::remove(directory_ / "catalog/KTLX.sqlite-shm");
    EXPECT_EQ(reader.count(), -1)
        << "a WAL without an index is an error until a writer opens the database";
    auto next = *CatalogWriter::open(directory_ / "catalog");
    EXPECT_EQ(next.list("KTLX", {})->size(), 1U);
    EXPECT_EQ(reader.count(), 1);
}

}  // namespace
}  // namespace stormcellar::catalog
