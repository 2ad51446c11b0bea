#include "device/udp_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace drake_haptics {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses Resolve(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw std::runtime_error("host '" + host +
                             "' was not found: " + gai_strerror(error));
  }
  return {found, &freeaddrinfo};
}

// Drivers commonly listen on IPv4 alone, even where "localhost" means both.
const addrinfo& Choose(const addrinfo* addresses) {
  for (const addrinfo* a = addresses; a != nullptr; a = a->ai_next) {
    if (a->ai_family == AF_INET) return *a;
  }
  return *addresses;
}

}  // namespace

UdpSocket::UdpSocket(const std::string& host, std::uint16_t port) {
  const Addresses addresses = Resolve(host, port);
  const addrinfo& peer = Choose(addresses.get());
  descriptor_ = socket(peer.ai_family, SOCK_DGRAM, 0);
  const bool open = descriptor_ >= 0 &&
                    fcntl(descriptor_, F_SETFL, O_NONBLOCK) == 0 &&
                    fcntl(descriptor_, F_SETFD, FD_CLOEXEC) == 0 &&
                    connect(descriptor_, peer.ai_addr, peer.ai_addrlen) == 0;
  if (!open) {
    const std::error_code error(errno, std::generic_category());
    if (descriptor_ >= 0) close(descriptor_);
    throw std::runtime_error("no socket to '" + host + "': " + error.message());
  }
}

UdpSocket::~UdpSocket() { close(descriptor_); }

void UdpSocket::Send(std::span<const unsigned char> packet) {
  // An error of this call or a later one may say that the peer is missing. It
  // is ignored, since UDP promises nothing either way.
  [[maybe_unused]] const ssize_t sent =
      send(descriptor_, packet.data(), packet.size(), 0);
}

std::ptrdiff_t UdpSocket::Receive(std::span<unsigned char> buffer) {
  const ssize_t size = recv(descriptor_, buffer.data(), buffer.size(), 0);
  if (size >= 0) return size;
  // The only error that is not the socket's own: nobody listened to a packet
  // that we sent. It is reported once, and packets may wait behind it.
  if (errno != ECONNREFUSED) return -1;
  return std::max<ssize_t>(-1,
                           recv(descriptor_, buffer.data(), buffer.size(), 0));
}

void UdpSocket::Wait(double timeout) const {
  pollfd item{descriptor_, POLLIN, 0};
  poll(&item, 1, static_cast<int>(std::ceil(1e3 * std::max(0.0, timeout))));
}

std::uint16_t UdpSocket::local_port() const {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size)) {
    return 0;
  }
  // The port is at the same place for IPv4 and IPv6.
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

}  // namespace drake_haptics
