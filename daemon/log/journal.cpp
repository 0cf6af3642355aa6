#include "daemon/log/journal.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

namespace stormcellar::daemon {
namespace {

constexpr timeval longest_wait{.tv_sec = 1, .tv_usec = 0};

// Sends a datagram to the socket at `path`, with the bytes or with the descriptor `passed`. Returns
// 0 or errno.
int send_to(int socket, const std::filesystem::path& path, std::string_view bytes, int passed) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.native().size() >= sizeof address.sun_path) return ENAMETOOLONG;
    std::memcpy(static_cast<char*>(address.sun_path), path.c_str(), path.native().size());
    iovec part{const_cast<char*>(bytes.data()), bytes.size()};
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof passed)> control{};
    msghdr message{};
    message.msg_name = &address;
    message.msg_namelen = sizeof address;
    message.msg_iov = &part;
    message.msg_iovlen = bytes.empty() ? 0 : 1;
    if (passed >= 0) {
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        cmsghdr* header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof passed);
        std::memcpy(CMSG_DATA(header), &passed, sizeof passed);
    }
    while (::sendmsg(socket, &message, MSG_NOSIGNAL) < 0)
        if (errno != EINTR) return errno;
    return 0;
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

}  // namespace

std::string journal_entry(std::span<const JournalField> fields) {
    std::string entry;
    for (const auto& [name, value] : fields) {
        entry += name;
        if (value.find('\n') == std::string::npos) {
            entry += '=';
        } else {
            entry += '\n';
            const std::uint64_t length = value.size();
            for (unsigned byte = 0; byte < sizeof length; ++byte)
                entry += static_cast<char>((length >> (8 * byte)) & 0xFFU);
        }
        entry += value;
        entry += '\n';
    }
    return entry;
}

Journal::Journal(std::filesystem::path socket)
    : path_(std::move(socket)), descriptor_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    // A journal that hangs must not block ingest.
    (void)::setsockopt(descriptor_.number(), SOL_SOCKET, SO_SNDTIMEO, &longest_wait,
                       sizeof longest_wait);
}

bool Journal::send(std::string_view entry) const {
    if (!descriptor_.is_open()) return false;
    const int problem = send_to(descriptor_.number(), path_, entry, -1);
    if (problem == EMSGSIZE || problem == ENOBUFS) return send_as_file(entry);
    return problem == 0;
}

bool Journal::send_as_file(std::string_view entry) const {
    const Descriptor file(::memfd_create("journal-entry", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    return file.is_open() && write_all(file.number(), entry) &&
           ::fcntl(file.number(), F_ADD_SEALS,
                   F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) == 0 &&
           send_to(descriptor_.number(), path_, {}, file.number()) == 0;
}

}  // namespace stormcellar::daemon
