"""Hand calculations of prestressed rectangular sections, in MN and m, so that stresses are in MPa. Tension and moments that pull the bottom are above zero."""


def fold(low, high, rises):
    """Where a function that rises crosses zero."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (low, middle) if rises(middle) > 0 else (middle, high)
    return (low + high) / 2


class Section:
    """width, height; steel: area of strands at a depth; young, young_steel: moduli. Uncracked, of whole concrete and strands (the concrete of their places is counted)."""

    def __init__(self, width, height, depth, steel, young, young_steel):
        self.width, self.height, self.depth, self.steel, self.young, self.young_steel = width, height, depth, steel, young, young_steel
        self.ratio = young_steel / young
        more = self.ratio * steel
        self.area = width * height + more
        self.axis = (width * height**2 / 2 + more * depth) / self.area  # below the top
        self.inertia = width * height**3 / 12 + width * height * (self.axis - height / 2)**2 + more * (depth - self.axis)**2

    def stress(self, below, force, moment=0.0):
        """Of the concrete at a depth, as strands that pull on it with a force before it gives way, and a moment, make it."""
        return -force / self.area + (moment - force * (self.depth - self.axis)) * (below - self.axis) / self.inertia

    def loss(self, force, moment=0.0):
        """By which the stress of the strands falls as the concrete gives way."""
        return -self.ratio * self.stress(self.depth, force, moment)

    def camber(self, force, span):
        """Of straight strands between supports (M l^2 / 8 E I)."""
        return force * (self.depth - self.axis) * span**2 / (8 * self.young * self.inertia)

    def moment_to(self, stress, force):
        """Moment under which the bottom has a stress."""
        return (stress - self.stress(self.height, force)) * self.inertia / (self.height - self.axis)

    def nominal_moment(self, strength, tension, yields, hardening, crushing=0.003):
        """(moment, stress of the strands) by ACI 318-19, 22.2: stress block of concrete that crushes at a strain, strands by a bilinear law; tension: of
        the strands where the concrete beside them has no strain."""
        block = max(0.65, 0.85 - 0.05 * (strength - 28) / 7)

        def of_strands(axis):
            strain = tension / self.young_steel + crushing * (self.depth - axis) / axis
            first = yields / self.young_steel
            return self.young_steel * strain if strain < first else yields + hardening * self.young_steel * (strain - first)

        axis = fold(1e-4 * self.height, self.height, lambda x: 0.85 * strength * self.width * block * x - self.steel * of_strands(x))
        return self.steel * of_strands(axis) * (self.depth - block * axis / 2), of_strands(axis)

    def cracked_moment(self, stress, strain):
        """(moment, compression of the top) of a cracked section of elastic concrete, at a stress of the strands; strain: by which they have been
        stretched since the concrete beside them had none."""
        axis = fold(1e-4 * self.height, self.depth * 0.999,
                    lambda x: self.width * x / 2 * self.young * strain * x / (self.depth - x) - self.steel * stress)
        return self.steel * stress * (self.depth - axis / 3), self.young * strain * axis / (self.depth - axis)


def flexural_strength(strength, height):
    """Of concrete of a tensile strength (fib Model Code 2010, 5.1-8)."""
    share = 0.06 * (1000 * height)**0.7
    return strength * (1 + share) / share


def transfer_length(around, steel, young, stress, strength, slip, share=0.95):
    """From an end to where strands of a perimeter have a share of their stress, in concrete that does not move, with bond of strength (s / slip)^0.4: the
    slip s'' = c s^0.4 grows with the power 10/3 of the way from where it begins."""
    c = around * strength / (young * steel * slip**0.4)
    grows = (c / (10 / 3 * 7 / 3))**(1 / 0.6)
    whole = (stress / young / (10 / 3 * grows))**(3 / 7)
    return whole * (1 - (1 - share)**(3 / 7))
