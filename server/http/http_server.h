#pragma once
// The HTTP library behind a small face: sockets, threads, the guards that it needs, and nothing of what is served.
//
// Guards (each one answers what was measured of cpp-httplib 0.11.4): a body must come with one plain Content-Length
// that its route allows, never chunked or compressed, and its bytes are counted against a budget for the whole server;
// a refusal closes the connection, for the refused body is still on its way; Range is ignored; no exception's text
// leaves. What can't be bounded here (the size of headers, clients that send them slowly) is for the proxy in front.

#include "server/http/router.h"

#include <cstddef>
#include <memory>
#include <string>

namespace toile {

struct HttpServerOptions {
  int threads = 64;                      ///< connections served at once; each keeps its thread while it is open
  int keep_alive_s = 5;                  ///< an idle connection is closed after this
  int read_timeout_s = 10;               ///< between two pieces of a request
  int write_timeout_s = 30;              ///< between two pieces of a response
  std::size_t body_budget = 256U << 20;  ///< bytes of request bodies in memory at once
};

class HttpServer {
 public:
  explicit HttpServer(Router router, HttpServerOptions options = {});
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

  /// Listens on a port, 0 for any free one; returns the port. Throws std::runtime_error when it is taken.
  int bind(const std::string& host, int port);
  /// Serves until stop(): running requests end, new ones are refused. Once stopped, never again. Throws
  /// std::runtime_error when connections can't be accepted any more, after running requests have ended.
  void serve();
  /// From any thread, any number of times, before serve() too, which then returns at once.
  void stop();

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

inline constexpr std::size_t kPathLimit = 1024;     ///< bytes of path and query
inline constexpr std::size_t kHeaderLimit = 100;    ///< header fields
inline constexpr std::size_t kHeaderBytes = 16384;  ///< of all header fields together

}  // namespace toile
