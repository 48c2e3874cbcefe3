/* Holds the kernel's CAN sockets to what a CANopen master needs of them: can_probe INTERFACE
 *
 * 1. CAN_RAW_FILTER lets through the identifiers asked for and no others, with standard and extended ones
 * distinguished.
 * 2. CAN_RAW_ERR_FILTER lets error frames through to those who ask, and to nobody else.
 * 3. CAN_BCM sends a frame cyclically, until it is stopped.
 * 4. CAN_BCM reports a frame whose content changed, and one that stays away.
 * Exit status 0: all of it. Waits are for events; only silence is measured, and it cannot be too long for us. */
#define _DEFAULT_SOURCE
#include <linux/can.h>
#include <linux/can/bcm.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { kPatienceMs = 30000, kSilenceMs = 200, kPeriodUs = 10000, kSentinel = 0x7f };

static struct sockaddr_can g_bus;

static void require(int holds, const char* what) {
  if (holds) return;
  perror(what);
  exit(1);
}

static int raw_socket(const struct can_filter* filters, size_t count) {
  const int s = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  require(s >= 0, "CAN_RAW socket");
  require(setsockopt(s, SOL_CAN_RAW, CAN_RAW_FILTER, filters, (socklen_t)(count * sizeof *filters)) == 0, "filters");
  require(bind(s, (const struct sockaddr*)&g_bus, sizeof g_bus) == 0, "bind");
  return s;
}

static int bcm_socket(void) {
  const int s = socket(PF_CAN, SOCK_DGRAM, CAN_BCM);
  require(s >= 0, "CAN_BCM socket");
  require(connect(s, (const struct sockaddr*)&g_bus, sizeof g_bus) == 0, "connect");
  return s;
}

static void send_frame(int s, canid_t id, unsigned char first_byte) {
  const struct can_frame frame = {.can_id = id, .can_dlc = 8, .data = {first_byte}};
  require(write(s, &frame, sizeof frame) == (ssize_t)sizeof frame, "send");
}

static int readable_within(int s, int ms) {
  struct pollfd watched = {.fd = s, .events = POLLIN};
  return poll(&watched, 1, ms) == 1;
}

static struct can_frame next_frame(int s) {
  struct can_frame frame;
  require(readable_within(s, kPatienceMs), "1, 2, 3: no frame came");
  require(read(s, &frame, sizeof frame) == (ssize_t)sizeof frame, "read");
  return frame;
}

/* The head ends in an array of frames without a length; this is room for one. */
union bcm_message {
  struct bcm_msg_head head;
  unsigned char bytes[sizeof(struct bcm_msg_head) + sizeof(struct can_frame)];
};

static void bcm_order(int s, __u32 opcode, __u32 flags, canid_t id, long period_us, unsigned char first_byte) {
  union bcm_message message;
  memset(&message, 0, sizeof message);
  message.head.opcode = opcode;
  message.head.flags = flags;
  message.head.can_id = id;
  message.head.nframes = 1;
  const struct can_frame frame = {.can_id = id, .can_dlc = 8, .data = {first_byte}};
  memcpy(message.bytes + sizeof message.head, &frame, sizeof frame);
  /* ival2 is the period of sending, ival1 the longest silence in receiving. */
  if (opcode == TX_SETUP) message.head.ival2.tv_usec = period_us;
  if (opcode == RX_SETUP) message.head.ival1.tv_usec = period_us;
  /* Of TX_DELETE it takes the head alone. */
  require(write(s, &message, sizeof message) >= (ssize_t)sizeof message.head, "order to the BCM");
}

static union bcm_message next_report(int s) {
  union bcm_message message;
  memset(&message, 0, sizeof message);
  require(readable_within(s, kPatienceMs), "4: no report of the BCM came");
  require(read(s, &message, sizeof message) >= (ssize_t)sizeof message.head, "read from the BCM");
  return message;
}

static void check_filters(int sender) {
  const struct can_filter wanted[] = {
      {.can_id = 0x123, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG},
      {.can_id = kSentinel, .can_mask = CAN_SFF_MASK},
  };
  const int s = raw_socket(wanted, 2);
  send_frame(sender, 0x122, 1);
  send_frame(sender, 0x123 | CAN_EFF_FLAG, 2);
  send_frame(sender, 0x123, 3);
  send_frame(sender, kSentinel, 4);
  require(next_frame(s).data[0] == 3, "1: the first frame is not the one asked for");
  require(next_frame(s).data[0] == 4, "1: the second frame is not the one asked for");
  close(s);
}

static void check_error_frames(int sender) {
  const struct can_filter sentinel = {.can_id = kSentinel, .can_mask = CAN_SFF_MASK};
  const can_err_mask_t bus_off = CAN_ERR_BUSOFF;
  const int asks = raw_socket(&sentinel, 1);
  const int does_not = raw_socket(&sentinel, 1);
  require(setsockopt(asks, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &bus_off, sizeof bus_off) == 0, "2: error filter");
  send_frame(sender, CAN_ERR_FLAG | CAN_ERR_BUSOFF, 5);
  send_frame(sender, kSentinel, 6);
  require(next_frame(asks).can_id == (CAN_ERR_FLAG | CAN_ERR_BUSOFF), "2: the error frame did not come");
  require(next_frame(asks).data[0] == 6, "2: the frame behind the error frame did not come");
  require(next_frame(does_not).data[0] == 6, "2: something came to a socket that did not ask for error frames");
  close(asks);
  close(does_not);
}

static void check_cyclic_sending(int sender) {
  const struct can_filter wanted[] = {
      {.can_id = 0x080, .can_mask = CAN_SFF_MASK},
      {.can_id = kSentinel, .can_mask = CAN_SFF_MASK},
  };
  const int s = raw_socket(wanted, 2);
  const int bcm = bcm_socket();
  bcm_order(bcm, TX_SETUP, SETTIMER | STARTTIMER, 0x080, kPeriodUs, 7);
  for (int i = 0; i < 20; ++i) require(next_frame(s).data[0] == 7, "3: a frame is not the one to send");
  bcm_order(bcm, TX_DELETE, 0, 0x080, 0, 0);
  send_frame(sender, kSentinel, 8);
  while (next_frame(s).data[0] != 8) continue; /* what was on its way */
  require(!readable_within(s, kSilenceMs), "3: the BCM goes on sending");
  close(bcm);
  close(s);
}

static void check_watching(int sender) {
  const int bcm = bcm_socket();
  bcm_order(bcm, RX_SETUP, SETTIMER | STARTTIMER, 0x701, kPeriodUs, 0xff);
  send_frame(sender, 0x701, 0x7f);
  send_frame(sender, 0x701, 0x05);
  int changes = 0;
  for (;;) {
    const union bcm_message report = next_report(bcm);
    if (report.head.opcode == RX_CHANGED) ++changes;
    if (report.head.opcode == RX_TIMEOUT && changes == 2) break;
  }
  close(bcm);
}

int main(int argc, char** argv) {
  require(argc == 2, "usage: can_probe INTERFACE");
  g_bus.can_family = AF_CAN;
  g_bus.can_ifindex = (int)if_nametoindex(argv[1]);
  require(g_bus.can_ifindex != 0, argv[1]);
  const int sender = raw_socket(NULL, 0);
  check_filters(sender);
  check_error_frames(sender);
  check_cyclic_sending(sender);
  check_watching(sender);
  close(sender);
  puts("can_probe: filters, error frames, cyclic sending and watching work");
  return 0;
}
