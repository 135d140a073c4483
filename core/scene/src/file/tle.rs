//! Two-line elements of a satellite: the key `tle` of an orbit.

use std::f64::consts::{PI, TAU};

use serde::Deserialize;

/// The mean elements of two lines at their epoch. Angles are in rad, in the frame of the true equator and mean equinox.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "Written")]
pub(crate) struct Lines {
    pub(crate) inclination: f64,
    pub(crate) ascending_node: f64,
    pub(crate) eccentricity: f64,
    pub(crate) argument_of_perigee: f64,
    pub(crate) mean_anomaly: f64,
    /// s.
    pub(crate) period: f64,
}

/// A text of two lines, below a title or not, or a list of them.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a `tle` is a text of two lines, or a list of two texts")]
enum Written {
    Text(String),
    List(Vec<String>),
}

/// Characters of a line; the last is the checksum.
const LENGTH: usize = 69;

impl TryFrom<Written> for Lines {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let text = match written {
            Written::Text(text) => text,
            Written::List(lines) => lines.join("\n"),
        };
        let lines: Vec<&str> = text.lines().map(str::trim_end).filter(|line| !line.is_empty()).collect();
        let (first, second) = match lines[..] {
            [first, second] | [_, first, second] => (checked(first, '1')?, checked(second, '2')?),
            _ => return Err(format!("a `tle` has two lines, and may have a title above them; found {}", lines.len())),
        };
        // The number of the satellite is in both lines.
        if first.get(2..7) != second.get(2..7) {
            return Err("the two lines of a `tle` are those of one satellite, with one number".to_owned());
        }
        let number = |place: std::ops::Range<usize>, what: &str| {
            let text = second.get(place).unwrap_or_default().trim();
            let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| format!("line 2 of a `tle` has no {what}: `{text}`"))
        };
        let angle = |place, what| number(place, what).map(|degrees| degrees * (PI / 180.0));
        let motion = number(52..63, "mean motion, turns a day, in columns 53 to 63")?;
        let digits = second.get(26..33).unwrap_or_default();
        // A point is assumed before the digits.
        let eccentricity = digits.bytes().all(|digit| digit.is_ascii_digit()).then(|| format!("0.{digits}").parse());
        match eccentricity {
            Some(Ok(eccentricity)) if motion > 0.0 => Ok(Self {
                inclination: angle(8..16, "inclination in columns 9 to 16")?,
                ascending_node: angle(17..25, "ascending node in columns 18 to 25")?,
                eccentricity,
                argument_of_perigee: angle(34..42, "argument of perigee in columns 35 to 42")?,
                mean_anomaly: angle(43..51, "mean anomaly in columns 44 to 51")? % TAU,
                period: 86_400.0 / motion,
            }),
            Some(Ok(_)) => Err("the mean motion of a `tle` is above zero".to_owned()),
            _ => Err(format!("line 2 of a `tle` has seven digits of the eccentricity in columns 27 to 33: `{digits}`")),
        }
    }
}

/// A line with its number in front, and with the checksum that its digits have; a sign `-` counts one.
fn checked(line: &str, number: char) -> Result<&str, String> {
    if !line.is_ascii() || line.len() != LENGTH || !line.starts_with(number) || line.as_bytes()[1] != b' ' {
        return Err(format!(
            "line {number} of a `tle` begins with `{number} ` and has {LENGTH} characters, found {}",
            line.chars().count()
        ));
    }
    let value =
        |byte: u8| if byte == b'-' { 1 } else { u32::from(byte.wrapping_sub(b'0')) * u32::from(byte.is_ascii_digit()) };
    let sum = line.bytes().take(LENGTH - 1).map(value).sum::<u32>() % 10;
    let own = line.as_bytes()[LENGTH - 1];
    if own.is_ascii_digit() && value(own) == sum {
        return Ok(line);
    }
    Err(format!("line {number} of a `tle` ends with the checksum {sum}, and this with `{}`", char::from(own)))
}
