// service/http_daemon.h -- starts libmicrohttpd on a listening socket, for the status of the daemon
// and for the data server.
//
// This file is a library of its own (stormcellar::http_daemon), so that services without HTTP need
// not link libmicrohttpd.
//
// Threads   Any thread.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <microhttpd.h>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct HttpResponseDeleter {
    void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
};
using HttpResponse = std::unique_ptr<MHD_Response, HttpResponseDeleter>;

struct HttpDaemonOptions {
    unsigned flags = 0;  // flags of libmicrohttpd (MHD_FLAG)
    unsigned most_connections = 0;
    std::size_t header_bytes = 0;                // limit of a request line with all headers
    void* self = nullptr;                        // passed to the callbacks
    MHD_AcceptPolicyCallback accepts = nullptr;  // null: accept all
    MHD_AccessHandlerCallback answer = nullptr;
    MHD_NotifyConnectionCallback connection = nullptr;
    std::vector<MHD_OptionItem> others = {};
};

// Starts a daemon of libmicrohttpd that serves a copy of the socket `listening`. That socket stays
// open. If libmicrohttpd starts threads, they block SIGPIPE. The caller ends the daemon with
// MHD_stop_daemon(). Errors: io.
[[nodiscard]] Result<MHD_Daemon*> start_http_daemon(int listening, HttpDaemonOptions options);

}  // namespace stormcellar
