#pragma once

/* The boundary between imunoise and the drivers of devices: plain C (C99 and later, C++), so that a
 * driver needs neither our compiler nor our library. In C++, drivers/plugin.h is more pleasant.
 *
 * A driver is a shared object "imunoise-NAME.so" with one exported function, imunoise_driver_entry.
 * docs/driver-guide.md tells the life cycle. In short:
 *
 *   entry -> open -> describe -> read, read, read ... -> close      (one thread at a time a device)
 *                                cancel                             (any thread, until close)
 *
 * Growth: every struct begins with its size in bytes as its maker knew it. Fields are only
 * appended; who reads a field beyond the size that is stated takes it for absent (0). Lists are
 * arrays of pointers, for the same reason. Anything else makes a new IMUNOISE_DRIVER_ABI.
 *
 * Memory: who allocates frees. Texts are UTF-8 and end with 0. What a driver describes stays valid
 * and unchanged: of the driver for ever (plugins are never unloaded), of a device until close.
 * No exception, no C++ type and no allocation crosses. */

/* NOLINTBEGIN: C, where clang-tidy expects C++. */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define IMUNOISE_DRIVER_ABI 1u
#define IMUNOISE_DRIVER_ENTRY "imunoise_driver_entry"

#if defined(__GNUC__)
#define IMUNOISE_DRIVER_EXPORT __attribute__((visibility("default")))
#else
#define IMUNOISE_DRIVER_EXPORT
#endif

/* What an operation came to. Negative: an error, with its text in imunoise_error. */
enum {
  IMUNOISE_OK = 0,
  IMUNOISE_TIMEOUT = 1, /* read: no sample came in time */
  IMUNOISE_CANCELLED =
      2,            /* read: cancel was called; so will every later read say; open: likewise */
  IMUNOISE_END = 3, /* read: nothing will ever come again (a replay is over) */

  IMUNOISE_FAILED = -1,      /* none of the others */
  IMUNOISE_BAD_OPTION = -2,  /* open: a value that this device cannot do */
  IMUNOISE_NOT_FOUND = -3,   /* open: no such device (or file) */
  IMUNOISE_NO_ACCESS = -4,   /* open: no permission, or in use by another program */
  IMUNOISE_BAD_DEVICE = -5,  /* the device answers, but not as it should: close it */
  IMUNOISE_DISCONNECTED = -6 /* disconnected. Reading may go on: the driver looks for it */
};

/* Types of stored numbers. */
enum {
  IMUNOISE_INT16 = 1,
  IMUNOISE_INT32 = 2,
  IMUNOISE_INT64 = 3,
  IMUNOISE_FLOAT32 = 4,
  IMUNOISE_FLOAT64 = 5
};

/* Flags of a sample (bits). Readers ignore bits they do not know. */
enum {
  IMUNOISE_SAMPLE_SATURATED = 1,    /* a channel is at the end of its range */
  IMUNOISE_SAMPLE_SUSPECT = 2,      /* the device reports a fault that does not spoil the numbers */
  IMUNOISE_SAMPLE_AFTER_GAP = 4,    /* samples were lost just before this one */
  IMUNOISE_SAMPLE_AFTER_RESTART = 8 /* counter and device time begin anew with this one */
};

/* Why samples that were received are not delivered. */
enum {
  IMUNOISE_REFUSED_OTHER = 0,
  IMUNOISE_REFUSED_CHECKSUM = 1,     /* the bytes are damaged */
  IMUNOISE_REFUSED_MALFORMED = 2,    /* the bytes are whole, but no sample of this stream */
  IMUNOISE_REFUSED_STALE = 3,        /* the device had nothing new and repeated itself */
  IMUNOISE_REFUSED_OUT_OF_RANGE = 4, /* a value that the sensor cannot have, or that is no number */
  IMUNOISE_REFUSED_FAULT = 5,        /* the device marks the sample as invalid */
  IMUNOISE_REFUSED_OVERRUN = 6,      /* a queue between device and driver ran over */
  IMUNOISE_REFUSED_SIBLING = 7,      /* another channel of the same sample was refused */
  IMUNOISE_REFUSED_REASONS = 8       /* how many reasons this header knows */
};

/* Types of options. Which member of imunoise_option_value holds the value: */
enum {
  IMUNOISE_OPTION_FLAG = 1,    /* integer, 0 or 1 */
  IMUNOISE_OPTION_INTEGER = 2, /* integer */
  IMUNOISE_OPTION_NUMBER = 3,  /* number */
  IMUNOISE_OPTION_TEXT = 4     /* text */
};

/* Properties of options (bits). */
enum {
  IMUNOISE_OPTION_REQUIRED = 1, /* the user must give it; there is no default */
  IMUNOISE_OPTION_REPEATED = 2  /* may be given several times */
};

/* Where an operation that fails says why: "what: where: the way out", one line. Host-owned. */
typedef struct imunoise_error {
  uint32_t size;
  uint32_t capacity; /* bytes of text, with the final 0 */
  char* text;        /* empty before the call */
} imunoise_error;

/* What the user may choose. */
typedef struct imunoise_option {
  uint32_t size;
  uint32_t type;             /* IMUNOISE_OPTION_FLAG ... */
  uint32_t properties;       /* bits IMUNOISE_OPTION_REQUIRED ... */
  uint32_t choice_count;     /* of a TEXT option; 0: any text */
  const char* name;          /* lower case letters, digits, '_' */
  const char* description;   /* one sentence */
  const char* unit;          /* "Hz", "s", ...; empty or NULL: none */
  const char* default_value; /* as a user writes it ("true", "100"); NULL: absent unless given */
  const char* const* choices;
  double minimum; /* of INTEGER and NUMBER, bounds included; -INFINITY, INFINITY: unbounded */
  double maximum;
} imunoise_option;

/* What the user chose, checked against the option by the host, defaults filled in. */
typedef struct imunoise_option_value {
  uint32_t size;
  uint32_t type;
  const char* name;
  int64_t integer;
  double number;
  const char* text;
} imunoise_option_value;

/* One column of samples. Value in units = add_offset + scale_factor * number. */
typedef struct imunoise_channel {
  uint32_t size;
  uint32_t number_type;  /* IMUNOISE_INT16 ... */
  const char* name;      /* unique in its stream, without '/': "gyro_x" */
  const char* long_name; /* "angular rate about x"; may be empty or NULL */
  const char* units;     /* "rad/s", "deg/s", "K", ...; "1" where none is known */
  double scale_factor;   /* units per number; not 0 */
  double add_offset;     /* units */
} imunoise_channel;

/* Channels that share one clock, one counter, one time column. */
typedef struct imunoise_stream {
  uint32_t size;
  uint32_t channel_count; /* at least 1 */
  const char* name;       /* unique in its device, without '/': "imu" */
  const imunoise_channel* const* channels;
  double nominal_rate_hz;    /* Hz; 0: not evenly sampled */
  uint64_t counter_maximum;  /* after it the device's sample counter is 0 again; 0: no counter */
  double device_time_tick_s; /* resolution of the device's own clock, s; 0: it tells no time */
} imunoise_stream;

/* What an open device is. Texts may be empty or NULL. */
typedef struct imunoise_device_info {
  uint32_t size;
  uint32_t stream_count; /* at least 1 */
  const imunoise_stream* const* streams;
  const char* product;  /* as the device names itself: "ADIS16405" */
  const char* serial;   /* tells this device from its like */
  const char* firmware; /* version */
} imunoise_device_info;

/* Buffers for samples of one stream, host-owned; the host zeroes refused, stream and rows.
 *
 * Sample i has host_time_ns[i], device_time_ns[i], counter[i], flags[i] and, in channel c, number i
 * of columns[c], which is an array of that channel's type. Columns are aligned for any number type.
 */
typedef struct imunoise_block {
  uint32_t size;
  uint32_t row_capacity;    /* samples that fit */
  uint32_t column_capacity; /* columns there are: as many as the widest stream has channels */
  uint32_t reason_count;    /* reasons for refusal that the host knows */
  int64_t* host_time_ns;    /* when it was taken or came, ns since 1970-01-01 UTC (host clock) */
  int64_t* device_time_ns;  /* device's clock, unwrapped, any origin, ns; unused if it has none */
  uint64_t* counter;        /* as the device counts, wrapping; unused if it has none */
  uint32_t* flags;          /* bits IMUNOISE_SAMPLE_SATURATED ... */
  void* const* columns;
  /* Samples of this stream refused since they were last told: refused[reason * column_capacity +
   * channel]. For each channel, received = delivered + refused. */
  uint64_t* refused;
  uint32_t stream; /* out: whose samples these are, index in imunoise_device_info */
  uint32_t rows;   /* out: samples delivered */
} imunoise_block;

/* Services of the host. Thread-safe; they return soon and hold no lock of the host. */
typedef struct imunoise_host {
  uint32_t size;
  uint32_t abi;
  /* The host's clock: ns since 1970-01-01 UTC. It never steps, even when the time of day is set. */
  int64_t (*now_ns)(void);
  /* Tells what a person should know of a device (one line, "reset after 3 bad checksums").
   * `context` is what open was given. Not after close. */
  void (*note)(void* context, const char* text);
  /* Takes bytes as they came over the device's wire, in the form of captures of its kind: Xbus
   * frames, lines of candump, SPI bursts. Calls of one device may not overlap. Returns 0 where
   * they are not wanted, as a call without bytes asks; else 1. `context` as above. Appended later:
   * look at size first. */
  int32_t (*wire)(void* context, const uint8_t* bytes, uint64_t count);
  /* For an open that waits: while it runs, the host calls cancel(argument) once it no longer wants
   * the device, from any thread, or here and now. Open then fails with IMUNOISE_CANCELLED as
   * soon as it can. NULL takes the request back: no call is under way when this returns, and none
   * follows; do so before open returns. `context` as above. Appended later: look at size first. */
  void (*while_opening)(void* context, void (*cancel)(void* argument), void* argument);
} imunoise_host;

typedef struct imunoise_device imunoise_device; /* the driver's own */

/* A driver: what it is and what it does. */
typedef struct imunoise_driver {
  uint32_t size;
  uint32_t abi;            /* IMUNOISE_DRIVER_ABI. These two stay first in every ABI */
  const char* name;        /* lower case letters, digits, '-', '_': "replay" */
  const char* description; /* one sentence */
  const char* version;     /* of the driver */
  uint32_t option_count;
  uint32_t stream_count; /* 0 where streams are known only of an open device */
  const imunoise_option* const* options;
  const imunoise_stream* const*
      streams; /* what a device usually delivers; NULL if stream_count is 0 */

  /* Finds and starts the device. On IMUNOISE_OK *device is set and will be closed; else nothing is
   * left behind. `context` is for imunoise_host.note. May take seconds; what waits for longer than
   * one asks for imunoise_host.while_opening. */
  int32_t (*open)(const imunoise_option_value* const* values, uint32_t value_count, void* context,
                  imunoise_device** device, imunoise_error* error);

  /* What the open device is. The same until close. */
  int32_t (*describe)(imunoise_device* device, const imunoise_device_info** info,
                      imunoise_error* error);

  /* Waits for samples, at most timeout_ms (0: does not wait), and delivers what has come of one
   * stream, in order, up to row_capacity; returns as soon as there is one. Other streams' samples,
   * and those that do not fit, are delivered by the next reads. IMUNOISE_OK: samples were delivered
   * or refused. IMUNOISE_TIMEOUT, _CANCELLED, _END, an error: neither. */
  int32_t (*read)(imunoise_device* device, int32_t timeout_ms, imunoise_block* block,
                  imunoise_error* error);

  /* Wakes a read that waits and makes every later one return IMUNOISE_CANCELLED. Returns at once.
   * From any thread, any number of times, between the return of open and the call of close. */
  void (*cancel)(imunoise_device* device);

  /* Stops the device and frees all of it. No other operation runs or follows. */
  void (*close)(imunoise_device* device);
} imunoise_driver;

/* The one exported function. Takes the ABI that the host speaks and its services, valid for ever;
 * returns the driver's table, valid for ever, or NULL where it has none for this ABI. The driver
 * must look at `host_abi` before it touches `host`; the host looks at the table's size and abi
 * before anything else of it. Called once. */
IMUNOISE_DRIVER_EXPORT const imunoise_driver* imunoise_driver_entry(uint32_t host_abi,
                                                                    const imunoise_host* host);

#ifdef __cplusplus
} /* extern "C" */
#endif
/* NOLINTEND */
