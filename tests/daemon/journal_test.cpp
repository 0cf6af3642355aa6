#include "daemon/log/journal.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/daemon/journal_socket.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

TEST(JournalEntry, IsNameAndValueLineByLine) {
    const std::array fields = {JournalField{"MESSAGE", "it is = so"}, JournalField{"PRIORITY", "6"},
                               JournalField{"EMPTY", ""}};
    EXPECT_EQ(journal_entry(fields), "MESSAGE=it is = so\nPRIORITY=6\nEMPTY=\n");
}

// Compares the exact bytes: the length of "a\nb" is 3, in 64 bits, little endian.
TEST(JournalEntry, AValueWithANewlineComesWithItsLength) {
    const std::array fields = {JournalField{"FILE", "a\nb"}, JournalField{"PRIORITY", "6"}};
    const std::string length = "\x03" + std::string(7, '\0');
    EXPECT_EQ(journal_entry(fields), "FILE\n" + length + "a\nb\nPRIORITY=6\n");
}

TEST(JournalEntry, NoValueCanForgeAField) {
    const std::string evil =
        "x\nPRIORITY=0\n\nMESSAGE\n=" + std::string(1, '\0') + "y" + std::string(300, '\n');
    const std::array fields = {JournalField{"STORMCELLAR_FILE", evil},
                               JournalField{"PRIORITY", "6"}};
    const auto read = read_journal_entry(journal_entry(fields));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, (JournalFields{{"STORMCELLAR_FILE", evil}, {"PRIORITY", "6"}}));
}

TEST(Journal, TakesEntriesOfAnySize) {
    const testing::TemporaryDirectory directory;
    JournalSocket socket(directory / "journal");
    const Journal journal(socket.path());
    bool was_file = false;
    for (const std::size_t size : {0, 1, 4096, 100'000, 8'000'000}) {
        const std::array fields = {JournalField{"MESSAGE", std::string(size, 'm')},
                                   JournalField{"LINES", std::string(size, '\n')}};
        ASSERT_TRUE(journal.send(journal_entry(fields))) << size;
        const auto read = socket.receive_fields();
        ASSERT_TRUE(read) << size;
        EXPECT_EQ(read->at("MESSAGE").size(), size);
        EXPECT_EQ(read->at("LINES"), std::string(size, '\n'));
        was_file = socket.was_file();
    }
    EXPECT_TRUE(was_file) << "16 MB are more than a datagram holds";
}

TEST(Journal, WhereNobodyListensSaysSo) {
    const testing::TemporaryDirectory directory;
    EXPECT_FALSE(Journal(directory / "nobody").send("MESSAGE=x\n"));
    EXPECT_FALSE(Journal(std::string(300, 'x')).send("MESSAGE=x\n"))
        << "the path is too long for a socket";
    std::optional<Journal> journal;
    {
        const JournalSocket socket(directory / "gone");
        journal.emplace(socket.path());
        EXPECT_TRUE(journal->send("MESSAGE=x\n"));
    }
    EXPECT_FALSE(journal->send("MESSAGE=x\n")) << "the reader is gone";
    std::filesystem::remove(directory / "gone");
    JournalSocket back(directory / "gone");
    EXPECT_TRUE(journal->send("MESSAGE=y\n")) << "the reader has come back";
    EXPECT_EQ(back.receive(), "MESSAGE=y\n");
}

TEST(Journal, AFullOneHoldsNobodyUpForLong) {
    const testing::TemporaryDirectory directory;
    const JournalSocket socket(directory / "journal");
    const Journal journal(socket.path());
    const std::string entry = "MESSAGE=" + std::string(1000, 'x') + "\n";
    int taken = 0;
    while (taken < 100'000 && journal.send(entry))
        ++taken;
    EXPECT_LT(taken, 100'000) << "if nobody reads, send() must fail at some point";
}

}  // namespace
}  // namespace stormcellar::daemon
