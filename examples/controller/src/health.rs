//! Health of the filter: the mean NIS of the last two hours.

const WINDOW: usize = 120;
/// The mean of 120 NIS of three components each leaves this by chance once in a million windows
/// (upper tail of chi-square with 360 degrees of freedom, over 120).
const LARGEST_MEAN: f32 = 4.2;

/// A window of NIS.
pub(crate) struct Health {
    nis: [f32; WINDOW],
    next: usize,
    count: usize,
}

impl Health {
    pub(crate) const fn new() -> Self {
        Self {
            nis: [0.0; WINDOW],
            next: 0,
            count: 0,
        }
    }

    pub(crate) fn add(&mut self, nis: f32) {
        if let Some(place) = self.nis.get_mut(self.next) {
            *place = nis;
        }
        self.next = if self.next + 1 < WINDOW {
            self.next + 1
        } else {
            0
        };
        self.count = (self.count + 1).min(WINDOW);
    }

    /// False if the innovations are larger than the filter expects, over a whole window.
    pub(crate) fn is_good(&self) -> bool {
        self.count < WINDOW || self.nis.iter().sum::<f32>() <= LARGEST_MEAN * WINDOW as f32
    }
}
