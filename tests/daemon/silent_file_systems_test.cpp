#include "daemon/process/silent_file_systems.h"

#include <gtest/gtest.h>
#include <linux/magic.h>

#include "daemon/watch/inotify.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

// Uses the kernel's names of the types of file systems, as far as the kernel's headers define them.
TEST(SilentFileSystems, ThoseThatOtherMachinesWriteTo) {
    EXPECT_EQ(silent_file_system(NFS_SUPER_MAGIC), "NFS");
    EXPECT_EQ(silent_file_system(SMB_SUPER_MAGIC), "SMB");
    EXPECT_EQ(silent_file_system(SMB2_SUPER_MAGIC), "SMB");
    EXPECT_EQ(silent_file_system(CIFS_SUPER_MAGIC), "CIFS");
    EXPECT_EQ(silent_file_system(FUSE_SUPER_MAGIC), "FUSE");
    EXPECT_EQ(silent_file_system(V9FS_MAGIC), "9P");
    EXPECT_EQ(silent_file_system(AFS_SUPER_MAGIC), "AFS");
    EXPECT_EQ(silent_file_system(AFS_FS_MAGIC), "AFS");
    EXPECT_EQ(silent_file_system(CEPH_SUPER_MAGIC), "Ceph");
    EXPECT_EQ(silent_file_system(CODA_SUPER_MAGIC), "Coda");
    EXPECT_EQ(silent_file_system(OCFS2_SUPER_MAGIC), "OCFS2");
    EXPECT_EQ(silent_file_system(0x0BD00BD0), "Lustre");
    EXPECT_EQ(silent_file_system(0x47504653), "GPFS");
}

TEST(SilentFileSystems, NotThoseOfThisMachine) {
    for (const std::uint32_t type :
         {std::uint32_t{EXT4_SUPER_MAGIC}, std::uint32_t{XFS_SUPER_MAGIC},
          std::uint32_t{BTRFS_SUPER_MAGIC}, std::uint32_t{TMPFS_MAGIC},
          std::uint32_t{F2FS_SUPER_MAGIC}, std::uint32_t{OVERLAYFS_SUPER_MAGIC}, 0U}) {
        EXPECT_FALSE(silent_file_system(type)) << type;
    }
    EXPECT_FALSE(silent_file_system_of("/proc"));
    EXPECT_FALSE(silent_file_system_of("/nowhere/at/all"));
}

TEST(SilentFileSystems, AreNamedByTheEvents) {
    const testing::TemporaryDirectory directory;
    const auto events = open_inotify();
    ASSERT_TRUE(events) << events.error().message;
    const auto silence = (*events)->silence(directory.path());
    const auto name = silent_file_system_of(directory.path());
    ASSERT_EQ(silence.has_value(), name.has_value());
    if (name) {
        EXPECT_EQ(*silence, directory.path().native() + ": is on " + std::string{*name} +
                                ", where the kernel does not report every change");
    }
    EXPECT_EQ(no_events()->silence(directory.path()), "") << "an earlier call gave the reason";
}

}  // namespace
}  // namespace stormcellar::daemon
