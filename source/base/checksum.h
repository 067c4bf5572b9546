/* Checksums of files: whether bytes are still those that were written. */
#ifndef BRECCIA_BASE_CHECKSUM_H
#define BRECCIA_BASE_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/** CRC-32 of a file's bytes from `from` on: that of ISO 3309, which zlib computes. It tells any change that lies within 32 bits from all others.
 *  @param[in] path  a file, no pipe or device
 *  @param[in] from, most  bytes before those that count, and how many count if there are as many
 *  @param[out] bytes  how many they are
 *  @return 0, or 1 with errno set */
int checksum_of_file(const char *path, int64_t from, int64_t most, uint32_t *sum, int64_t *bytes);

/** Computes the same checksum of a file that is open. @param[in] file  descriptor, open for reading */
int checksum_of_descriptor(int file, int64_t from, int64_t most, uint32_t *sum, int64_t *bytes);

/** The same of bytes in memory. */
uint32_t checksum_of(const void *bytes, size_t size);
/** Of bytes that follow others. @param[in] sum  of those; 0 where there are none */
uint32_t checksum_with(uint32_t sum, const void *bytes, size_t size);

#endif
