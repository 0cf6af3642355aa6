#include "daemon/process/silent_file_systems.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <sys/statfs.h>

namespace stormcellar::daemon {
namespace {

struct Known {
    std::uint32_t type;
    std::string_view name;
};

constexpr std::array<Known, 21> silent = {{
    {0x00006969, "NFS"},
    {0x0000517B, "SMB"},
    {0xFE534D42, "SMB"},
    {0xFF534D42, "CIFS"},
    {0x0000564C, "NCP"},
    {0x65735546, "FUSE"},
    {0x01021997, "9P"},
    {0x5346414F, "AFS"},
    {0x6B414653, "AFS"},
    {0x73757245, "Coda"},
    {0x00C36400, "Ceph"},
    {0x0BD00BD0, "Lustre"},
    {0x47504653, "GPFS"},
    {0x7461636F, "OCFS2"},
    {0x01161970, "GFS2"},
    {0x19830326, "BeeGFS"},
    {0xAAD7AAEA, "PanFS"},
    {0x20030528, "OrangeFS"},
    {0x786F4256, "a VirtualBox folder"},
    {0xBACBACBC, "a VMware folder"},
    {0x00C0FFEE, "hostfs"},
}};

}  // namespace

std::optional<std::string_view> silent_file_system(std::uint32_t type) {
    const auto found = std::find_if(silent.begin(), silent.end(),
                                    [&](const Known& known) { return known.type == type; });
    if (found == silent.end()) return std::nullopt;
    return found->name;
}

std::optional<std::string_view> silent_file_system_of(const std::filesystem::path& directory) {
    struct statfs facts {};
    int failed = 0;
    do {
        failed = ::statfs(directory.c_str(), &facts);
    } while (failed != 0 && errno == EINTR);
    if (failed != 0) return std::nullopt;
    return silent_file_system(static_cast<std::uint32_t>(facts.f_type));
}

}  // namespace stormcellar::daemon
