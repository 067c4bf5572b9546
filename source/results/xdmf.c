#include "results/xdmf.h"

#include "base/text.h"
#include <stdio.h>
#include <stdlib.h>

/** A field at one write: a slab of its dataset, in which the writes follow one another. */
static void add_field(Text *text, const XdmfSeries *series, const XdmfField *field, long long write)
{
  long long n = series->particles, all = n * (long long)series->writes;
  int k = field->components;
  char shape[64], whole[64], slab[128];
  if (k > 1) {
    snprintf(shape, sizeof shape, "%lld %d", n, k);
    snprintf(whole, sizeof whole, "%lld %d", all, k);
    snprintf(slab, sizeof slab, "%lld 0 1 1 %lld %d", n * write, n, k);
  } else {
    snprintf(shape, sizeof shape, "%lld", n);
    snprintf(whole, sizeof whole, "%lld", all);
    snprintf(slab, sizeof slab, "%lld 1 %lld", n * write, n);
  }
  const char *kind = k == 1 ? "Scalar" : k == 3 ? "Vector" : "Matrix";
  text_add(text,
           "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\"><DataItem ItemType=\"HyperSlab\" "
           "Dimensions=\"%s\"><DataItem Dimensions=\"3 %d\" Format=\"XML\">%s</DataItem>"
           "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"%d\" Dimensions=\"%s\">"
           "results.vtkhdf:/VTKHDF/PointData/%s</DataItem></DataItem></Attribute>\n",
           field->name, kind, shape, k > 1 ? 2 : 1, slab, series->bytes, whole, field->name);
}

int xdmf_write(const char *path, const XdmfSeries *series)
{
  Text text = {0};
  text_add(&text, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n"
                  "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  long long n = series->particles;
  for (int64_t w = 0; w < series->writes; ++w) {
    text_add(&text,
             "   <Grid Name=\"step %lld\">\n    <Time Value=\"%.17g\"/>\n"
             "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%lld\"/>\n"
             "    <Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
             "Dimensions=\"%lld 3\">results.vtkhdf:/VTKHDF/Points</DataItem></Geometry>\n",
             (long long)series->steps[w], series->times[w], n, n);
    for (int f = 0; f < series->count; ++f) add_field(&text, series, &series->fields[f], (long long)w);
    text_add(&text, "   </Grid>\n");
  }
  text_add(&text, "  </Grid>\n </Domain>\n</Xdmf>\n");
  char *temporary = text_format("%s.part", path);
  FILE *out = temporary ? fopen(temporary, "w") : NULL;
  int bad = !out || fwrite(text.characters, 1, text.length, out) != text.length;
  if (out && fclose(out)) bad = 1;
  bad = bad || rename(temporary, path);
  free(temporary);
  text_free(&text);
  return bad;
}
