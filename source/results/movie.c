#include "results/movie.h"

#include "base/program.h"
#include "base/regular_file.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool movie_format(const char *path)
{
  const char *dot = strrchr(path, '.');
  return dot && !strcmp(dot, ".mp4");
}

/** All frames, one behind the other, in a file without a name. */
static int draw_frames(const ResultView *view, const PictureOptions *o, bool each_range, FILE *frames, int *wide,
                       int *high, Error *error)
{
  PictureSurvey survey;
  int status = picture_survey(view, 0, view->steps - 1, true, o, &survey, error);
  for (int k = 0; k < view->steps && !status; ++k) {
    PictureSurvey here = survey;
    if (each_range) status = picture_survey(view, k, k, false, o, &here, error);
    here.x0 = survey.x0;
    here.x1 = survey.x1;
    here.y0 = survey.y0;
    here.y1 = survey.y1;
    if (status) break;
    int w, h;
    unsigned char *pixels = picture_pixels(view, k, o, &here, &w, &h, error);
    if (!pixels) return BRECCIA_FAILURE;
    if (k && (w != *wide || h != *high)) /* the encoder is told one size for all */
      status = error_add(error, BRECCIA_FAILURE, "frames of different size: %d x %d and %d x %d", *wide, *high, w, h);
    *wide = w;
    *high = h;
    if (!status && fwrite(pixels, 4, (size_t)w * (size_t)h, frames) != (size_t)w * (size_t)h)
      status = error_add(error, BRECCIA_FAILURE, "the frames of the movie cannot be written: %s", strerror(errno));
    free(pixels);
  }
  return status;
}

static int encode(FILE *frames, int wide, int high, double rate, const char *path, Error *error)
{
  char size[48], speed[48];
  snprintf(size, sizeof size, "%dx%d", wide, high);
  snprintf(speed, sizeof speed, "%g", rate);
  char *part = text_format("%s.part", path);
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  /* Even below ten frames a second the file has twenty-five, which old players need; what repeats costs nothing. */
  const char *const words[] = {"ffmpeg",
                               "-nostdin",
                               "-y",
                               "-loglevel",
                               "error",
                               "-f",
                               "rawvideo",
                               "-pixel_format",
                               "bgr0",
                               "-video_size",
                               size,
                               "-framerate",
                               speed,
                               "-i",
                               "pipe:0",
                               "-r",
                               rate < 10 ? "25" : speed,
                               "-c:v",
                               "libx264",
                               "-crf",
                               "20",
                               "-pix_fmt",
                               "yuv420p",
                               "-movflags",
                               "+faststart",
                               "-f",
                               "mp4",
                               part,
                               NULL};
  Text reason = {0};
  int status = BRECCIA_OK;
  const int cause = regular_file_make(part);
  if (cause) {
    status = error_add(error, BRECCIA_FAILURE, "%s: not made: %s", path, regular_file_problem(cause));
    free(part);
    return status;
  }
  const ProgramEnd end = program_feed(words, frames, &reason);
  if (end == PROGRAM_MISSING)
    status = error_add(error, BRECCIA_FAILURE,
                       "%s: movies are made by ffmpeg, which is not installed: install it (Debian: apt install ffmpeg) "
                       "and try again",
                       path);
  else if (end == PROGRAM_FAILED)
    status = error_add(error, BRECCIA_FAILURE, "%s: not made: %s", path, reason.characters);
  else if (rename(part, path))
    status = error_add(error, BRECCIA_FAILURE, "%s: not made: %s", path, strerror(errno));
  if (status) remove(part);
  text_free(&reason);
  free(part);
  return status;
}

int movie_make(const ResultView *view, const PictureOptions *options, bool each_range, double rate, const char *path,
               Error *error)
{
  if (!movie_format(path)) return error_add(error, BRECCIA_USER_ERROR, "%s: movies end in .mp4", path);
  if (view->steps < 2)
    return error_add(
        error, BRECCIA_USER_ERROR,
        "%s: a movie needs more than the %d written step that there is; 'results: {number: 100}' in the deck "
        "writes more",
        path, view->steps);
  PictureOptions o = *options;
  o.one_of_many = true;
  if (!(rate > 0)) rate = fmin(25, fmax(2, round(view->steps / 10.0)));
  FILE *frames = tmpfile();
  int wide = 0, high = 0;
  int status = frames ? draw_frames(view, &o, each_range, frames, &wide, &high, error)
                      : error_add(error, BRECCIA_FAILURE, "no temporary file for the frames: %s", strerror(errno));
  if (!status) status = encode(frames, wide, high, rate, path, error);
  if (frames) fclose(frames);
  return status;
}
