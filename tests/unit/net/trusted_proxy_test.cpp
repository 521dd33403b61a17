// Clients behind trusted proxies: who counts as the client, and what a peer that is not a proxy can claim.
#include <gmock/gmock.h>

#include <spindrift/http/network_text.h>
#include <spindrift/http/trusted_networks.h>

#include "test_application.h"

namespace spindrift::net {
namespace {

using test::eventually;
using test::HttpAnswer;
using test::httpRequest;
using test::RawTcp;
using test::TestServer;

boost::asio::ip::address address(const std::string& text) {
  return boost::asio::ip::make_address(text);
}

TrustedNetworks networks(const std::vector<std::string>& texts) {
  auto parsed = TrustedNetworks::parse(texts);
  EXPECT_TRUE(parsed) << parsed.error().message;
  return parsed ? *std::move(parsed) : TrustedNetworks();
}

std::string reasonAgainst(const std::string& text) {
  const auto checked = checkNetwork(text);
  return checked ? "" : checked.error().message;
}

/// The client, "none" without an entry, or "refused".
std::string clientOf(const std::vector<std::string_view>& lines,
                     const std::vector<std::string>& trusted = {"10.0.0.0/8", "fd00::/8"}) {
  const auto client = forwardedClient(lines, networks(trusted));
  if (!client) return "refused";
  return *client ? (*client)->to_string() : "none";
}

TEST(TrustedNetworks, HoldTheAddressesOfTheirPrefixAndNoOthers) {
  const TrustedNetworks known = networks({"10.0.0.0/8", "192.0.2.7", "2001:db8::/33", "::1"});
  for (const char* inside : {"10.0.0.0", "10.255.255.255", "192.0.2.7", "2001:db8::5", "2001:db8:7fff::", "::1"})
    EXPECT_TRUE(known.contains(address(inside))) << inside;
  for (const char* outside : {"11.0.0.0", "9.255.255.255", "192.0.2.8", "2001:db8:8000::", "::2", "127.0.0.1", "::"})
    EXPECT_FALSE(known.contains(address(outside))) << outside;
  EXPECT_FALSE(TrustedNetworks().contains(address("127.0.0.1")));
}

TEST(TrustedNetworks, AnIpv4AddressInItsMappedFormIsTheSameAddress) {
  EXPECT_TRUE(networks({"10.0.0.0/8"}).contains(address("::ffff:10.1.2.3")));
  EXPECT_TRUE(networks({"::ffff:10.0.0.0/104"}).contains(address("10.1.2.3")));
  EXPECT_EQ(limitKey(address("::ffff:10.1.2.3")), limitKey(address("10.1.2.3")));
  EXPECT_EQ(limitKey(address("2001:db8::1")), limitKey(address("2001:db8::2")));
  EXPECT_NE(limitKey(address("2001:db8::1")), limitKey(address("2001:db8:0:1::1")));
}

TEST(TrustedNetworks, AllOfOneFamilyHoldNothingOfTheOther) {
  EXPECT_TRUE(networks({"0.0.0.0/0"}).contains(address("203.0.113.9")));
  EXPECT_FALSE(networks({"0.0.0.0/0"}).contains(address("2001:db8::1")));
  EXPECT_FALSE(networks({"::/0"}).contains(address("203.0.113.9")));
}

TEST(TrustedNetworks, TextThatIsNoNetworkIsRefusedWithTheReason) {
  using testing::HasSubstr;
  EXPECT_EQ(reasonAgainst("10.0.0.0/8"), "");
  EXPECT_EQ(reasonAgainst("10.0.0.1/8"), "'10.0.0.1/8' has bits set behind its first 8: write 10.0.0.0/8");
  EXPECT_EQ(reasonAgainst("2001:db8::1/32"), "'2001:db8::1/32' has bits set behind its first 32: write 2001:db8::/32");
  EXPECT_EQ(reasonAgainst("10.0.0.0/33"), "'10.0.0.0/33': the part behind '/' is a number of bits from 0 to 32");
  EXPECT_EQ(reasonAgainst("::/129"), "'::/129': the part behind '/' is a number of bits from 0 to 128");
  for (const char* text : {"", "/", "proxy.example", "10.0.0/8", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.0/8/8",
                           "10.0.0.0/255.0.0.0", "fe80::1%eth0", "fe80::%eth0/10", " 10.0.0.0/8", "1.2.3.4:80"})
    EXPECT_NE(reasonAgainst(text), "") << text;
}

TEST(ForwardedClient, IsTheRightmostAddressThatIsNoProxy) {
  EXPECT_EQ(clientOf({}), "none");
  EXPECT_EQ(clientOf({"203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"198.51.100.1, 203.0.113.9, 10.0.0.2"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"198.51.100.1", "203.0.113.9 ,\t10.0.0.2", "10.0.0.3"}), "203.0.113.9") << "several headers";
  EXPECT_EQ(clientOf({"10.0.0.4,10.0.0.3"}), "10.0.0.4") << "only proxies: the first of them asks for itself";
}

TEST(ForwardedClient, IsReadInEveryFormThatProxiesWrite) {
  EXPECT_EQ(clientOf({"203.0.113.9:4711"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"2001:db8::9"}), "2001:db8::9");
  EXPECT_EQ(clientOf({"[2001:db8::9]"}), "2001:db8::9");
  EXPECT_EQ(clientOf({"[2001:db8::9]:4711"}), "2001:db8::9");
  EXPECT_EQ(clientOf({"::ffff:203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"203.0.113.9, ::ffff:10.0.0.2"}), "203.0.113.9") << "a mapped proxy is still a proxy";
}

TEST(ForwardedClient, WhatIsNoAddressIsRefused) {
  for (const char* entry : {"",
                            " ",
                            ",",
                            "203.0.113.9,",
                            "unknown",
                            "_hidden",
                            "client.example",
                            "203.0.113",
                            "203.0.113.256",
                            "203.0.113.9:",
                            "203.0.113.9:port",
                            "203.0.113.9:65536",
                            "203.0.113.9:-1",
                            "[203.0.113.9]",
                            "[2001:db8::9",
                            "2001:db8::9]",
                            "[2001:db8::9]4711",
                            "[]",
                            "[]:80",
                            "fe80::1%eth0",
                            "203.0.113.9 10.0.0.2",
                            "\"203.0.113.9\"",
                            "for=203.0.113.9",
                            "0x7f.1",
                            "017700000001",
                            "2001:db8::9::1",
                            "1.2.3.4.5"})
    EXPECT_EQ(clientOf({entry}), "refused") << entry;
}

TEST(ForwardedClient, WhatAClientWritesInFrontOfItsOwnAddressHasNoEffect) {
  EXPECT_EQ(clientOf({"127.0.0.1, 203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"10.0.0.1, 203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(clientOf({"<script>", "\"; drop", "203.0.113.9"}), "203.0.113.9");
}

TEST(ForwardedClient, ThousandsOfEntriesAreReadOnce) {
  std::string many = "203.0.113.9";
  for (int k = 0; k < 100'000; ++k) many += ",10.0.0.1";
  EXPECT_EQ(clientOf({many}), "203.0.113.9");
}

TEST(ForwardedClient, TheReasonNamesHeaderAndEntryInPrintableText) {
  const std::string_view line = "203.0.113.9, \x01<\xff>";
  const auto client = forwardedClient({&line, 1}, networks({"10.0.0.0/8"}));
  ASSERT_FALSE(client);
  EXPECT_EQ(
      client.error().message,
      "The X-Forwarded-For header has the entry '%01<%FF>', which is not an IP address: the proxy in front of this "
      "server has to write one.");
}

ServerOptions behindProxy(ServerOptions options = {}) {
  options.trusted_proxies = {"127.0.0.0/8"};
  return options;
}

/// The addresses that send two requests more than the burst of one request allows: 429 for the second.
HttpAnswer ask(const TestServer& served, const std::string& forwarded) {
  return httpRequest(served.server->port(), "GET", "/healthz", "X-Forwarded-For: " + forwarded + "\r\n");
}

const ServerOptions kOneRequest{.address_requests_per_s = 1e-3, .address_request_burst_count = 1.0};

TEST(TrustedProxy, TwoClientsBehindOneProxyHaveLimitsOfTheirOwn) {
  const TestServer served(behindProxy(kOneRequest));
  EXPECT_EQ(ask(served, "203.0.113.1").status, 200u);
  EXPECT_EQ(ask(served, "203.0.113.2").status, 200u);
  EXPECT_EQ(ask(served, "203.0.113.1").status, 429u);
  EXPECT_EQ(ask(served, "203.0.113.2").status, 429u);
  EXPECT_EQ(ask(served, "198.51.100.1, 203.0.113.1").status, 429u) << "an entry in front of it makes no new client";
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/healthz").status, 200u) << "the proxy itself";
}

TEST(TrustedProxy, AHeaderFromAnyOtherPeerHasNoEffect) {
  ServerOptions options = kOneRequest;
  options.trusted_proxies = {"192.0.2.0/24", "::1"};
  const TestServer served(options);
  EXPECT_EQ(ask(served, "203.0.113.1").status, 200u);
  EXPECT_EQ(ask(served, "203.0.113.2").status, 429u) << "both are 127.0.0.1";
  EXPECT_EQ(ask(served, "garbage").status, 429u) << "it is not even read";
}

TEST(TrustedProxy, AMalformedHeaderIsRefusedWith400) {
  const TestServer served(behindProxy());
  const HttpAnswer answer = ask(served, "unknown");
  EXPECT_EQ(answer.status, 400u);
  EXPECT_THAT(answer.body, testing::HasSubstr("X-Forwarded-For header has the entry 'unknown'"));
  EXPECT_EQ(served.server->stats().refused_count[static_cast<std::size_t>(Refused::kRequest)], 1u);
}

TEST(TrustedProxy, RequestsOfOneConnectionMayBelongToSeveralClients) {
  const TestServer served(behindProxy(kOneRequest));
  RawTcp proxy;
  ASSERT_TRUE(proxy.connect("127.0.0.1", served.server->port()));
  const auto status = [&](const std::string& more) {
    EXPECT_TRUE(proxy.send("GET /healthz HTTP/1.1\r\nHost: a\r\n" + more + "\r\n"));
    return proxy.receiveUntil("ok\n").substr(0, 12);
  };
  EXPECT_EQ(status("X-Forwarded-For: 203.0.113.1\r\n"), "HTTP/1.1 200");
  EXPECT_EQ(status("X-Forwarded-For: 203.0.113.2\r\n"), "HTTP/1.1 200");
  EXPECT_EQ(status(""), "HTTP/1.1 200") << "the client of an earlier request is not that of a later one";
}

TEST(TrustedProxy, SessionsCountForTheirClientAndAreLoggedWithIt) {
  const TestServer served(behindProxy({.max_session_count = 4, .address_session_share = 0.25}));
  const auto upgrade = [&](const std::string& client) {
    RawTcp peer;
    EXPECT_TRUE(peer.connect("127.0.0.1", served.server->port()));
    EXPECT_TRUE(
        peer.send("GET /ws HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: " + client +
                  "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                  "c3BpbmRyaWZ0IHRlc3RzIQ==\r\n\r\n"));
    EXPECT_FALSE(peer.receiveUntil("\r\n").empty());
    return peer;
  };
  const RawTcp first = upgrade("203.0.113.1");
  const RawTcp second = upgrade("2001:db8::2");
  ASSERT_TRUE(eventually([&] { return served.application.peers().size() == 2; }));
  EXPECT_THAT(served.application.peers()[0], testing::StartsWith("203.0.113.1 by 127.0.0.1:"));
  EXPECT_THAT(served.application.peers()[1], testing::StartsWith("2001:db8::2 by 127.0.0.1:"));
  const RawTcp third = upgrade("203.0.113.1");
  EXPECT_TRUE(
      eventually([&] { return served.server->stats().refused_count[static_cast<std::size_t>(Refused::kFull)] == 1; }));
}

TEST(TrustedProxy, ANetworkThatIsNoneIsRefusedAtTheStart) {
  test::TestApplication application;
  const auto started = Server::start({.port = 0, .trusted_proxies = {"10.0.0.1/8"}}, application);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_THAT(started.error().message, testing::StartsWith("--trust-proxy '10.0.0.1/8' has bits set"));
}

}  // namespace
}  // namespace spindrift::net
