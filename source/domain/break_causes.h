/* Causes of broken bonds, as BREAK_CAUSE(NAME, word, criterion, quantity, has_limit, count, about): the members of
 * BreakCauseType (domain/domain.h). A new cause is a line here and a deck in tests/unit/failure/test_break_causes.c. */
BREAK_CAUSE(LIMIT, "limit", NULL, NULL, true, "exceeded the limit of",
            "the bond exceeded the limit of the failure criterion; a bond between two materials has the smaller limit")
BREAK_CAUSE(LAW, "law", "law found no stress", "stretch", false,
            "because the law of their point, or of an end, found no stress",
            "the law of the bond, or of one of its ends, found no stress (`failed laws: break`); the value is the "
            "stretch of the bond, and there is no limit")
BREAK_CAUSE(ISOLATED, "isolated", "too few bonds left", "evenness of neighbours", true,
            "because too few bonds were left at one of their ends",
            "earlier broken bonds left the bond of a hybrid body too few common neighbours for a strain; the value is "
            "the smallest principal second moment of their positions over the largest, and the bond breaks at the "
            "limit or below")
