//! An archive in the format ZIP, whose files are stored as they are.

/// The checksum of the format: CRC-32 with the reflected polynomial `edb88320`.
fn checksum(bytes: &[u8]) -> u32 {
    let shifted = |sum: u32, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 };
    !bytes.iter().fold(!0, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), shifted))
}

/// The archive of these files, by path and bytes, of the first of January 1980; none where it would have more than 4 GiB. The
/// same files have the same bytes.
#[must_use]
pub fn archive(files: &[(String, Vec<u8>)]) -> Option<Vec<u8>> {
    let (mut all, mut directory) = (Vec::new(), Vec::new());
    for (path, bytes) in files {
        let (size, length) = (u32::try_from(bytes.len()).ok()?, u16::try_from(path.len()).ok()?);
        let place = u32::try_from(all.len()).ok()?;
        let mut head = Vec::new();
        // Version 2.0, names in UTF-8, stored, the time, and the first day of the calendar.
        head.extend([20_u16, 1 << 11, 0, 0, 1 << 5 | 1].into_iter().flat_map(u16::to_le_bytes));
        head.extend([checksum(bytes), size, size].into_iter().flat_map(u32::to_le_bytes));
        head.extend([length, 0].into_iter().flat_map(u16::to_le_bytes));
        all.extend(b"PK\x03\x04");
        all.extend(&head);
        all.extend(path.as_bytes());
        all.extend(bytes);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&head);
        // No comment, the first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(place.to_le_bytes());
        directory.extend(path.as_bytes());
    }
    let (count, place) = (u16::try_from(files.len()).ok()?, u32::try_from(all.len()).ok()?);
    let size = u32::try_from(directory.len()).ok()?;
    all.extend(&directory);
    all.extend(b"PK\x05\x06");
    all.extend([0, 0, count, count].into_iter().flat_map(u16::to_le_bytes));
    all.extend([size, place].into_iter().flat_map(u32::to_le_bytes));
    all.extend([0; 2]);
    Some(all)
}
