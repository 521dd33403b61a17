#include <utility>

#include <spindrift/cluster/edge_server.h>

namespace spindrift::cluster {
namespace {

net::HttpReply text(unsigned status, std::string body) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = std::move(body)};
}

}  // namespace

core::Result<std::unique_ptr<EdgeServer>> EdgeServer::start(EdgeOptions options) {
  auto self = std::unique_ptr<EdgeServer>(new EdgeServer(std::move(options.access)));
  options.node.runs_rooms = false;
  auto node = Node::connect(options.node);
  if (!node) return node.error();
  self->node_ = *std::move(node);
  auto network = net::Server::start(options.network, *self);
  if (!network) return network.error();
  self->network_ = *std::move(network);
  self->started_ = self->network_.get();
  return self;
}

EdgeServer::~EdgeServer() {
  stop();
}

void EdgeServer::drain(std::chrono::milliseconds closes_in, const std::string& go_to) {
  is_draining_ = true;
  sessions_.drain(*network_, closes_in, go_to);
}

void EdgeServer::stop() {
  if (network_) network_->stop();
  node_.reset();
}

void EdgeServer::serverStarts(net::Hub& hub) {
  sessions_.serve(hub);
  node_->serve(sessions_, {});
}

core::Result<void> EdgeServer::acceptSession(const std::string& room) {
  return node_->accept(room);
}

void EdgeServer::sessionOpened(net::SessionId session, const net::SessionOpening& opening) {
  if (auto venue = node_->find(opening.room)) return sessions_.opened(session, std::move(venue), opening);
  sessions_.refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
}

void EdgeServer::httpRequest(const net::HttpRequest& request, net::HttpResponder respond) {
  const bool is_probe = request.path == "/healthz" || request.path == "/readyz" || request.path == "/metrics";
  if (is_probe && request.method != "GET") return respond(text(405, "the method is not allowed here: use GET\n"));
  if (request.path == "/healthz") return respond(text(200, "ok\n"));
  if (request.path == "/readyz") {
    if (is_draining_) return respond(text(503, "draining\n"));
    const auto ready = node_->ready();
    return respond(ready ? text(200, "ready\n") : text(503, ready.error().message + "\n"));
  }
  if (request.path == "/metrics") {
    net::Server* const network = started_;
    net::HttpReply page{.status = 200, .content_type = "text/plain; version=0.0.4; charset=utf-8", .body = ""};
    if (network) page.body = service::metricsText(network->stats(), counters_);
    page.body += node_->hooks().metrics();
    return respond(std::move(page));
  }
  if (node_->takeRequest(request, respond)) return;
  respond(std::nullopt);
}

}  // namespace spindrift::cluster
