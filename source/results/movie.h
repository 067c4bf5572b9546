/* Movies of a field over time, made by ffmpeg from pictures in memory. */
#ifndef BRECCIA_RESULTS_MOVIE_H
#define BRECCIA_RESULTS_MOVIE_H

#include "results/picture.h"

/** Every written step as one frame, with one colour range (unless `each_range`) and one framing, in a form that every player shows (H.264).
 *  @param[in] rate  frames a second; 0: so that it lasts about ten seconds
 *  @param[in] path  ends in .mp4 */
int movie_make(const ResultView *view, const PictureOptions *options, bool each_range, double rate, const char *path,
               Error *error);

/** True if a file name ends as movies do. */
bool movie_format(const char *path);

#endif
