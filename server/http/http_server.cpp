#include "server/http/http_server.h"

#include "server/http/problem_response.h"
#include "server/store/store.h"

#include <httplib.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <mutex>
#include <utility>

namespace toile {
namespace {

constexpr int kBacklog = 256;  // connections that wait to be accepted; the library's own 5 resets bursts

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool takes_body(const std::string& method) { return method == "POST"; }

/// The body's length as told; a problem for a request whose body can't be bounded.
std::size_t checked_length(const httplib::Request& request, const BodyRule& rule) {
  if (request.has_header("Transfer-Encoding")) {
    throw HttpProblem(411, "length_required", "Send the body with Content-Length, not chunked.");
  }
  if (request.has_header("Content-Encoding")) {
    throw HttpProblem(415, "encoding_not_supported", "Send the body as it is, not compressed.");
  }
  const std::size_t lengths = request.get_header_value_count("Content-Length");
  if (lengths == 0) {
    if (takes_body(request.method)) throw HttpProblem(411, "length_required", "Send the body with Content-Length.");
    return 0;
  }
  const std::string text = request.get_header_value("Content-Length");
  const bool digits =
      !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  if (lengths > 1 || !digits) throw HttpProblem(400, "bad_content_length", "Content-Length must be one plain number.");
  const std::size_t length = text.size() > 12 ? SIZE_MAX : std::stoull(text);
  if (length > rule.limit) {
    throw HttpProblem(413, "body_too_large",
                      rule.limit == 0 ? "This request takes no body."
                                      : "The body may have " + std::to_string(rule.limit) + " bytes at most.");
  }
  return length;
}

void check_media_type(const httplib::Request& request, const BodyRule& rule) {
  std::string type = lower_case(request.get_header_value("Content-Type"));
  type = type.substr(0, type.find(';'));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  if (rule.json_only && type != "application/json") {
    throw HttpProblem(415, "media_type_not_supported", "Send JSON with Content-Type: application/json (curl: --json).");
  }
  if (type.substr(0, 10) == "multipart/") {
    throw HttpProblem(415, "media_type_not_supported",
                      "Send the file's bytes as the body (curl: --data-binary @file).");
  }
}

void check_size_of_head(const httplib::Request& request) {
  if (request.target.size() > kPathLimit) throw HttpProblem(414, "path_too_long", "The path is too long.");
  std::size_t bytes = 0;
  for (const auto& [name, value] : request.headers) bytes += name.size() + value.size();
  if (request.headers.size() > kHeaderLimit || bytes > kHeaderBytes) {
    throw HttpProblem(431, "headers_too_large", "The request has too many or too large header fields.");
  }
}

/// Bytes of the budget while a body is in memory.
class BudgetShare {
 public:
  BudgetShare(std::atomic<std::size_t>& used, std::size_t bytes, std::size_t budget) : used_(used), bytes_(bytes) {
    if (used_.fetch_add(bytes_) + bytes_ > budget) {
      used_ -= bytes_;
      throw HttpProblem(503, "too_many_uploads", "Too many uploads at once.").with_header("Retry-After", "2");
    }
  }
  BudgetShare(const BudgetShare&) = delete;
  BudgetShare& operator=(const BudgetShare&) = delete;
  ~BudgetShare() { used_ -= bytes_; }

 private:
  std::atomic<std::size_t>& used_;
  std::size_t bytes_;
};

void write_to(httplib::Response& target, HttpResponse response) {
  target.status = response.status;
  for (const auto& [name, value] : response.headers) target.set_header(name, value);
  if (!response.body.empty() || response.status != 304) target.set_header("Content-Type", response.content_type);
  target.set_header("X-Content-Type-Options", "nosniff");
  target.set_header("Accept-Ranges", "none");  // the library would say that it takes them
  target.body = std::move(response.body);
}

/// Runs `body` and turns whatever it throws into a response; what is no problem of the client's stays in the log.
template <typename Body>
HttpResponse answer(const httplib::Request& request, const Body& body) {
  try {
    return body();
  } catch (const HttpProblem& problem) {
    return problem_response(problem);
  } catch (const InputError& error) {
    return problem_response(error);
  } catch (const StoreError& error) {
    spdlog::error("{} {}: {}", request.method, request.path, error.what());
    if (error.kind() == StoreError::Kind::full) {
      return problem_response(HttpProblem(507, "store_full", "The server has no room left."));
    }
    return problem_response(
        HttpProblem(503, "store_unavailable", "The store does not answer.").with_header("Retry-After", "5"));
  } catch (const std::exception& error) {
    spdlog::error("{} {}: {}", request.method, request.path, error.what());
  } catch (...) {
    spdlog::error("{} {}: unknown exception", request.method, request.path);
  }
  return problem_response(HttpProblem(500, "internal_error", "Something went wrong in the server; its log says what."));
}

HttpRequest plain_request(const httplib::Request& source) {
  HttpRequest request;
  request.method = source.method;
  request.path = source.path;
  for (const auto& [name, value] : source.params) request.query.emplace(name, value);
  for (const auto& [name, value] : source.headers) request.headers.emplace(lower_case(name), value);
  return request;
}

}  // namespace

struct HttpServer::Library {
  Router router;
  HttpServerOptions options;
  httplib::Server server;
  std::atomic<std::size_t> body_bytes{0};
  socket_t listener = -1;
  std::mutex stopping;
  bool stop_asked = false;
  bool can_stop = false;

  /// The library's stop() does nothing before it runs; one that comes earlier is kept until it does.
  void stop() {
    const std::scoped_lock lock(stopping);
    if (!std::exchange(stop_asked, true) && can_stop) server.stop();
  }

  /// The library makes its queue when it counts as running and before it accepts a connection: the one moment at which
  /// a kept stop() can be carried out without leaving a gap on either side.
  httplib::TaskQueue* begin() {
    const std::scoped_lock lock(stopping);
    can_stop = true;
    if (stop_asked) server.stop();
    return new httplib::ThreadPool(static_cast<std::size_t>(options.threads));
  }

  /// The checks that need no body. Throws HttpProblem.
  RouteMatch admit(const httplib::Request& request) const {
    check_size_of_head(request);
    RouteMatch match = router.match(request.method, request.path);
    checked_length(request, match.route->body);
    if (takes_body(request.method)) check_media_type(request, match.route->body);
    return match;
  }

  void handle(const httplib::Request& source, httplib::Response& target, const httplib::ContentReader* reader) {
    write_to(target, answer(source, [&] {
               const RouteMatch match = admit(source);
               HttpRequest request = plain_request(source);
               request.captures = match.captures;
               const std::size_t length = checked_length(source, match.route->body);
               const BudgetShare share(body_bytes, length, options.body_budget);
               if (reader != nullptr && length > 0) {
                 request.body.reserve(length);
                 (*reader)([&](const char* data, std::size_t size) {
                   if (request.body.size() + size > length) return false;
                   request.body.append(data, size);
                   return true;
                 });
                 if (request.body.size() != length)
                   throw HttpProblem(400, "body_cut_short", "The body ended too early.");
               }
               return match.route->handle(request);
             }));
  }

  /// Refuses before the library reads a body, so that the rest of the connection is not taken for a next request.
  bool refuse(const httplib::Request& source, httplib::Response& target) const {
    // The library would cut every body by these; it offers no other way to ignore the header, which is a server's
    // right.
    const_cast<httplib::Request&>(source).ranges.clear();
    bool refused = false;
    HttpResponse response = answer(source, [&]() -> HttpResponse {
      try {
        admit(source);
        return {};
      } catch (const HttpProblem&) {
        refused = true;
        throw;
      }
    });
    if (!refused) return false;
    const bool has_body = source.has_header("Content-Length") || source.has_header("Transfer-Encoding");
    if (has_body || takes_body(source.method)) response.headers.emplace_back("Connection", "close");
    write_to(target, std::move(response));
    return true;
  }
};

HttpServer::HttpServer(Router router, HttpServerOptions options) : library_(std::make_unique<Library>()) {
  Library* const library = library_.get();
  library->router = std::move(router);
  library->options = options;
  httplib::Server& server = library->server;
  server.new_task_queue = [library] { return library->begin(); };
  server.set_tcp_nodelay(true);
  server.set_keep_alive_max_count(1000);
  server.set_keep_alive_timeout(options.keep_alive_s);
  server.set_read_timeout(options.read_timeout_s);
  server.set_write_timeout(options.write_timeout_s);
  server.set_payload_max_length(SIZE_MAX);  // the routes' own limits apply; this one would answer without a body
  server.set_socket_options([library](socket_t socket) {
    // Not the library's SO_REUSEPORT, which lets a second server take the same port in silence.
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    library->listener = socket;
  });

  using Handling = httplib::Server::HandlerResponse;
  server.set_pre_routing_handler([library](const httplib::Request& request, httplib::Response& response) {
    return library->refuse(request, response) ? Handling::Handled : Handling::Unhandled;
  });
  server.set_expect_100_continue_handler([library](const httplib::Request& request, httplib::Response& response) {
    return library->refuse(request, response) ? response.status : 100;
  });
  const auto without_body = [library](const httplib::Request& request, httplib::Response& response) {
    library->handle(request, response, nullptr);
  };
  server.Get(".*", without_body);
  server.Delete(".*", without_body);
  server.Post(".*", [library](const httplib::Request& request, httplib::Response& response,
                              const httplib::ContentReader& reader) { library->handle(request, response, &reader); });
  server.set_exception_handler([](const httplib::Request& request, httplib::Response& response, std::exception_ptr) {
    write_to(response,
             answer(request, []() -> HttpResponse { throw std::logic_error("exception outside a handler"); }));
  });
  server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (!response.body.empty()) return;  // a handler has said it
    write_to(response, problem_response(HttpProblem(response.status, "bad_request", "The request could not be read.")));
  });
}

HttpServer::~HttpServer() { stop(); }

int HttpServer::bind(const std::string& host, int port) {
  const int bound = port == 0                                   ? library_->server.bind_to_any_port(host)
                    : library_->server.bind_to_port(host, port) ? port
                                                                : -1;
  if (bound <= 0) throw std::runtime_error("can't listen on " + host + ":" + std::to_string(port));
  listen(library_->listener, kBacklog);
  return bound;
}

void HttpServer::serve() {
  if (library_->server.listen_after_bind()) return;
  const std::scoped_lock lock(library_->stopping);
  if (!library_->stop_asked) throw std::runtime_error("the HTTP server can't accept connections any more");
}
void HttpServer::stop() { library_->stop(); }

}  // namespace toile
