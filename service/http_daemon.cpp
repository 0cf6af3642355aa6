#include "service/http_daemon.h"

#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <sys/stat.h>

#include "base/system_error.h"
#include "service/signals.h"
#include "stormcellar/base/descriptor.h"

namespace stormcellar {
namespace {

bool is_same_file(int a, int b) {
    struct stat of_a {
    }, of_b{};
    return ::fstat(a, &of_a) == 0 && ::fstat(b, &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
           of_a.st_ino == of_b.st_ino;
}

}  // namespace

Result<MHD_Daemon*> start_http_daemon(int listening, HttpDaemonOptions options) {
    // libmicrohttpd closes the descriptor that it gets, so pass a copy.
    Descriptor own{::fcntl(listening, F_DUPFD_CLOEXEC, 3)};
    if (!own.is_open()) return system_failure("libmicrohttpd cannot start", errno);
    options.others.push_back({MHD_OPTION_END, 0, nullptr});
    // Block SIGPIPE for the threads that libmicrohttpd starts. Otherwise, when sendfile(2) sends to
    // a client that is gone, the signal would end the program.
    const BlockedSignals blocked({SIGPIPE});
    MHD_Daemon* daemon = MHD_start_daemon(
        options.flags, 0, options.accepts, options.self, options.answer, options.self,
        MHD_OPTION_LISTEN_SOCKET, own.number(), MHD_OPTION_CONNECTION_LIMIT,
        options.most_connections, MHD_OPTION_CONNECTION_MEMORY_LIMIT, options.header_bytes,
        MHD_OPTION_NOTIFY_CONNECTION, options.connection, options.self,
        MHD_OPTION_SIGPIPE_HANDLED_BY_APP, 1, MHD_OPTION_ARRAY, options.others.data(),
        MHD_OPTION_END);
    // Do not close the copy here. Either the daemon owns the copy now, or libmicrohttpd has closed
    // the copy after a failure.
    if (daemon != nullptr || !is_same_file(own.number(), listening)) (void)own.release();
    if (daemon == nullptr) return fail(ErrorCode::io, "libmicrohttpd cannot start");
    return daemon;
}

}  // namespace stormcellar
