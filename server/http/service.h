#pragma once
// What the service offers, path by path: the routes of /v1 on a store and a dispatcher. The contract that people read
// is schemas/openapi.json.

#include "server/http/preview.h"
#include "server/http/router.h"
#include "server/queue/clock.h"
#include "server/queue/dispatcher.h"
#include "server/store/store.h"

namespace toile {

struct ServiceOptions {
  int max_queued = 10000;  ///< jobs waiting at once
};

/// What the handlers work on; outlives the router.
struct Service {
  Store& store;
  Dispatcher& dispatcher;
  PreviewRenderer& previews;
  Clock clock = system_time_ms;
  ServiceOptions options;
};

/// All routes of the service.
Router make_router(Service& service);
/// /healthz alone, for a port of its own.
Router make_health_router(Service& service);

void add_asset_routes(Router& router, Service& service);
void add_job_routes(Router& router, Service& service);
void add_result_routes(Router& router, Service& service);
void add_library_routes(Router& router);
void add_health_routes(Router& router, Service& service);

inline constexpr std::size_t kSceneLimit = 16U << 20;      ///< bytes of a job's request
inline constexpr std::size_t kAssetLimit = 64U << 20;      ///< bytes of an asset
inline constexpr int kPageDefault = 50, kPageLimit = 200;  ///< jobs a page

}  // namespace toile
